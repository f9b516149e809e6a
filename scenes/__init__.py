"""What is drawn and played of a document that is more than single blocks; run by the page of `simulate`."""

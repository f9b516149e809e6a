"""What Brython runs in the page. All but `page` is plain Python and runs in tests too."""

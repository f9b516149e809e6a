"""EKS Light FSA on Siemens S7-300, operation mode selection with touchscreen: the four devices and their
composition.
"""

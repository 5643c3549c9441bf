"""What passed on a link, in a file: written beside the control loop, read, and replayed."""

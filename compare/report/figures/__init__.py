"""Every figure of the report, redrawn: its drawings are lost, its captions and numbers are not."""

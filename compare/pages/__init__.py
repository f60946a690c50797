"""Static HTML pages: of the report's rows, or of a system of one's own.

`printed` and `own` say what stands on the pages, frozen and without a word of HTML; `render` turns
that into files by the templates beside it; `compare.output_folder` writes them whole or not at all.
"""

"""The one report this began with, reproduced: tables, errata, programs, figures, claims."""

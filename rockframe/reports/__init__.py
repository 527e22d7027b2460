"""Reports on runs and studies: one page that needs no other file."""

from rockframe.reports.writing import report as report

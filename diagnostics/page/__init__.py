"""How a page looks and speaks: HTML, style, wording, tables, provenance."""

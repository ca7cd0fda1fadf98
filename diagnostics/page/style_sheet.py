"""The style of a page: for a phone, a desk and paper, without anything loaded from elsewhere."""

from __future__ import annotations

STYLE = """
:root{color-scheme:light;--ink:#1c2733;--soft:#566573;--line:#dde3e8;--band:#f5f7f9;--accent:#1f6f8b;
--paper:#fff;--warm:#fff7e6}
@media screen and (prefers-color-scheme:dark){:root{color-scheme:dark;--ink:#e6ebef;--soft:#a9b6c1;--line:#3a4650;
--band:#1f272e;--accent:#7cc4dd;--paper:#14191d;--warm:#33291a}}
*{box-sizing:border-box}
body{margin:0;font:16px/1.55 system-ui,-apple-system,"Segoe UI",Roboto,sans-serif;color:var(--ink);
background:var(--paper)}
main{max-width:1120px;margin:0 auto;padding:1.2rem 1rem 4rem}
h1{font-size:1.55rem;line-height:1.25;margin:.4rem 0 1rem;overflow-wrap:anywhere}
h2{font-size:1.2rem;margin:2.4rem 0 .6rem;padding-top:.8rem;border-top:1px solid var(--line)}
p,li{max-width:46rem;overflow-wrap:anywhere}
.first{font-size:1.06rem;padding:.8rem 1rem;background:var(--warm);border-left:4px solid #e3a21a;
border-radius:0 6px 6px 0;max-width:none}
.note{padding:.6rem 1rem;background:var(--band);border-left:4px solid var(--soft);
border-radius:0 6px 6px 0;max-width:none}
.caption,figcaption{font-size:.9rem;color:var(--soft)}
.caption{margin:1.4rem 0 .4rem;max-width:none}
.caption b,figcaption b{color:var(--ink)}
.figures{display:grid;grid-template-columns:repeat(auto-fill,minmax(min(100%,430px),1fr));gap:1.2rem;align-items:start;margin-top:1.2rem}
figure{margin:0;border:1px solid var(--line);border-radius:8px;padding:.6rem}
figure img{display:block;width:100%;height:auto;border-radius:4px}
figcaption{margin-top:.4rem}.behind{margin:.3rem 0 0}
td a{color:inherit;text-decoration-color:var(--soft)}
.scroll{overflow-x:auto;border:1px solid var(--line);border-radius:8px}
.scroll:focus-visible,button:focus-visible{outline:2px solid var(--accent);outline-offset:1px}
.tall{max-height:34rem;overflow-y:auto}
table{border-collapse:separate;border-spacing:0;font-size:.9rem;width:100%;font-variant-numeric:tabular-nums}
th,td{padding:.35rem .6rem;text-align:right;vertical-align:top;white-space:nowrap;border-bottom:1px solid var(--line)}
tbody th{font-weight:inherit}
th:first-child{text-align:left;white-space:normal;min-width:11rem;overflow-wrap:anywhere;position:sticky;left:0;
background:var(--paper);border-right:1px solid var(--line)}
thead th{position:sticky;top:0;background:var(--band);vertical-align:bottom;white-space:normal;
min-width:3.2rem;z-index:1}
thead th:first-child{background:var(--band);z-index:2}
tbody tr:last-child>*{border-bottom:0}
td small,th small{display:block;color:var(--soft)}
thead button{all:unset;cursor:pointer;display:inline-block}
thead button::after{content:"\\00a0\\2195";color:#7d8994}
th[aria-sort=ascending] button::after{content:"\\00a0\\2191";color:var(--accent)}
th[aria-sort=descending] button::after{content:"\\00a0\\2193";color:var(--accent)}
table.text th,table.text td{text-align:left;white-space:normal;min-width:7rem}
.printed{display:none}
a{color:var(--accent)}th a{color:inherit;text-decoration-color:var(--soft)}
.answer{display:grid;grid-template-columns:minmax(0,1fr) minmax(0,1.1fr);gap:1.2rem;align-items:start}
.answer p{margin:0 0 .7rem;max-width:none}.answer figure{margin:0}
.contents ul{display:flex;flex-wrap:wrap;gap:.2rem 1.1rem;list-style:none;margin:1rem 0 0;padding:.6rem 0;
border:solid var(--line);border-width:1px 0}
.contents li{max-width:none}
:target{scroll-margin-top:1rem;background:var(--warm)}
code{overflow-wrap:anywhere;font-size:.88em}
@media(max-width:800px){.answer{grid-template-columns:minmax(0,1fr);gap:.4rem}}
@media(max-width:600px){body{font-size:15px;line-height:1.45}.answer p{margin-bottom:.45rem}
main{padding:.6rem .7rem 3rem}h1{font-size:1.3rem}figure{padding:.3rem}
th,td{padding:.3rem .4rem}th:first-child{min-width:8.5rem;max-width:10rem}}
"""

PRINT_STYLE = """
@page{margin:14mm 12mm}
@media print{html{font-size:10pt}body{font-size:1rem;line-height:1.4}
main{max-width:none;padding:0}p,li{max-width:none}h2{margin-top:1.4rem}
.scroll{overflow:visible;border:0}.tall{max-height:none}
table{border-collapse:collapse;font-size:.85rem}table.wide{font-size:.64rem}
th:first-child,thead th,thead th:first-child{position:static;background:none;border-right:0}
thead th{border-bottom:1.5pt solid var(--ink);min-width:0}tbody th:first-child{min-width:11em}
table.text td{min-width:0}table.text tbody th:first-child{min-width:8em}
th,td{padding:.15rem .3rem}table.wide th,table.wide td{padding:.12rem .18rem}
table.wider{font-size:.58rem}table.wider small{white-space:normal}
thead{display:table-header-group}thead button{display:contents}thead button::after{content:""!important}
tr,figure,.note,.short{break-inside:avoid}
h1,h2,h3,.caption{break-after:avoid}.caption,figcaption{font-size:.85rem}p{orphans:3;widows:3}
.cut tbody tr:nth-child(n+ROWS){display:none}.printed{display:block;break-before:avoid}
.figures{grid-template-columns:1fr 1fr;gap:.8rem}figure{padding:.3rem}
.answer{grid-template-columns:minmax(0,1fr) minmax(0,1fr)}
.first,.note{background:none}}
"""


SHADES = "".join(
    f".shade{tenth}{{background:color-mix(in srgb,#1f6f8b {7 * tenth}%,var(--paper))}}"
    f".shade{tenth} small{{color:inherit}}\n"
    for tenth in range(11)
)
"""Cells of a heat map, near enough to the paper, light or dark, that text keeps a contrast of 4.5."""


def style_sheet(printed_rows: int) -> str:
    """Return the style; of a table that is cut on paper so many rows are printed."""
    return STYLE + SHADES + PRINT_STYLE.replace("ROWS", str(printed_rows + 1))

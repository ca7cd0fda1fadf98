"""What a page may do, as its first element says: its own scripts and nothing else, no network.

A text of a stranger's set or recording that came into the page as markup could then still run nothing and send nothing.

The script that sorts a table by a click on a head or a key; without it tables stay as written.
"""

from __future__ import annotations

import base64
import hashlib
from collections.abc import Sequence

HINT_SCRIPT = """
document.querySelectorAll('a[href^="#"]').forEach(function(link){
var place=document.getElementById(link.hash.slice(1));
if(place&&place.dataset.hint)link.title=place.dataset.hint});
"""
"""A definition stands once on the page: repeated in every row it would make a page a tenth larger."""

SORT_SCRIPT = """
document.querySelectorAll("table.sortable").forEach(function(table){
var body=table.tBodies[0],heads=Array.from(table.tHead.rows[0].cells);
var key=function(row,column){var cell=row.cells[column],value=cell.dataset.value;
if(value!==undefined)return value===""?null:+value;
var text=cell.firstChild?cell.firstChild.textContent.trim():"",number=Number(text.replace("\u2212","-"));
return text!==""&&!isNaN(number)?number:cell.textContent};
heads.forEach(function(head,column){
var button=document.createElement("button");button.type="button";button.title="Sort by this column";
while(head.firstChild)button.appendChild(head.firstChild);
head.appendChild(button);head.setAttribute("aria-sort","none");
button.addEventListener("click",function(){
var rows=Array.from(body.rows),before=head.getAttribute("aria-sort");
var text=rows.some(function(row){return typeof key(row,column)==="string"});
var down=before==="none"?!text:before==="ascending";
heads.forEach(function(other){other.setAttribute("aria-sort","none")});
head.setAttribute("aria-sort",down?"descending":"ascending");
rows.sort(function(a,b){var x=key(a,column),y=key(b,column);
if(x===null||y===null)return(x===null)-(y===null);
var order=typeof x==="number"&&typeof y==="number"?x-y:String(x).localeCompare(String(y),"en",{numeric:true});
return down?-order:order}).forEach(function(row){body.appendChild(row)})})})});
"""
"""Undefined values (an empty data-value) stay last in both directions; numbers begin with the largest, text with a."""


def security_policy(scripts: Sequence[str]) -> str:
    """Return the element with a page's content security policy.

    Parameters
    ----------
    scripts : sequence of str
        What stands between the tags of every script that runs, to the letter. Attributes such as onclick never run.
    """
    hashes = " ".join(map(script_hash, scripts))
    rules = [
        "default-src 'none'",
        f"script-src {hashes}",
        "style-src 'unsafe-inline'",  # style attributes have no hash; a style loads nothing under these rules
        "img-src data:",
        "base-uri 'none'",
        "form-action 'none'",
    ]
    return f'<meta http-equiv="Content-Security-Policy" content="{"; ".join(rules)}">'


def script_hash(script: str) -> str:
    """Return by what a policy allows a script that stands in a page."""
    # what a browser hashes: line ends of the document are read as \n
    content = script.replace("\r\n", "\n").replace("\r", "\n")
    return f"'sha256-{base64.b64encode(hashlib.sha256(content.encode()).digest()).decode()}'"

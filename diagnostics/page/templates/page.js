// A definition stands once on the page: repeated in every row it would make a page a tenth larger.
document.querySelectorAll('a[href^="#"]').forEach(function(link){
var place=document.getElementById(link.hash.slice(1));
if(place&&place.dataset.hint)link.title=place.dataset.hint});
// Undefined values (an empty data-value) stay last both ways; numbers begin with the largest, text with a.
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

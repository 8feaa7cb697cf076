"""One self-contained HTML page: images inline, no external resource, good on screen and on paper."""
import base64
import html
import os

CSS = """
:root { --ink:#2b2a28; --quiet:#77726b; --rule:#e2ddd4; --paper:#fdfcfa; --warn:#9a4a1f; }
* { box-sizing:border-box }
html { background:var(--paper) }
body { color:var(--ink); font:16px/1.55 Georgia,'Iowan Old Style','Times New Roman',serif; margin:0 auto;
       max-width:1080px; padding:48px 28px 80px }
h1 { font-size:2.1rem; font-weight:600; line-height:1.15; margin:0 0 .3rem; letter-spacing:-.01em }
h2 { font-size:1.25rem; font-weight:600; margin:2.8rem 0 .7rem; padding-top:.8rem; border-top:1px solid var(--rule) }
p { max-width:44em; margin:.5rem 0 }
.sub { color:var(--quiet); font-style:italic }
.sans,table,figcaption,.cards,nav { font-family:'Helvetica Neue',Arial,'Liberation Sans',sans-serif }
.cards { display:grid; grid-template-columns:repeat(auto-fill,minmax(150px,1fr)); gap:1px; background:var(--rule);
         border:1px solid var(--rule); margin:1.6rem 0 }
.card { background:#fff; padding:14px 16px }
.card .value { font-size:1.5rem; font-weight:600; white-space:nowrap; font-variant-numeric:tabular-nums }
.card .value small { font-size:.8rem; font-weight:400; color:var(--quiet) }
.card .name { font-size:.78rem; color:var(--quiet); line-height:1.35 }
.card.bad .value { color:var(--warn) }
.grid { display:grid; grid-template-columns:repeat(auto-fit,minmax(min(440px,100%),1fr)); gap:26px 30px;
        align-items:start }
figure { margin:0; break-inside:avoid }
figure.wide { grid-column:1/-1 }
figure.portrait { max-width:760px; margin:0 auto }
figure.narrow { max-width:560px; margin:0 auto }
img { width:100%; height:auto; display:block; background:#fff; border:1px solid var(--rule) }
figcaption { font-size:.82rem; line-height:1.45; color:#4b4742; margin-top:.5rem }
.missing { border:1px dashed #cfc8bc; padding:14px 16px; color:var(--quiet); font-size:.85rem;
           font-family:'Helvetica Neue',Arial,sans-serif }
.note { border-left:3px solid #c9952b; padding:.2rem 0 .2rem 1rem; margin:1.2rem 0 }
table { border-collapse:collapse; font-size:.84rem; margin:.6rem 0; width:100% }
th { text-align:left; font-weight:600; border-bottom:1.5px solid var(--ink); padding:5px 14px 5px 0;
     vertical-align:bottom }
td { border-bottom:1px solid var(--rule); padding:5px 14px 5px 0; vertical-align:top }
td.n,th.n { text-align:right; font-variant-numeric:tabular-nums; white-space:nowrap }
td.quiet { color:var(--quiet) }
footer { margin-top:3rem; border-top:1px solid var(--rule); padding-top:.8rem; color:var(--quiet); font-size:.8rem }
@media print {
  @page { size:A4; margin:16mm 15mm }
  html { background:#fff } body { padding:0; max-width:none; font-size:10.5pt }
  .grid { grid-template-columns:1fr 1fr; gap:14px 18px } h2 { break-after:avoid; margin-top:1.6rem }
  figure.portrait { max-width:128mm } figure.narrow { max-width:100mm } tr { break-inside:avoid }
}
"""


def text(value):
    return html.escape(str(value), quote=True)


def image(path, alt):
    with open(path, "rb") as file:
        data = base64.b64encode(file.read()).decode()
    return f'<img alt="{text(alt)}" src="data:image/png;base64,{data}">'


def figure(path, caption, kind=""):
    name = os.path.splitext(os.path.basename(path))[0].replace("_", " ")
    return (f'<figure class="{kind}">{image(path, name)}<figcaption>{text(caption)}</figcaption></figure>')


def missing(title, why):
    return f'<div class="missing"><b>{text(title)}</b> is not shown: {text(why)}.</div>'


def cards(items):
    """items: (name, value, unit, is it bad)."""
    body = "".join(f'<div class="card{" bad" if bad else ""}"><div class="value">{text(value)} '
                   f'<small>{text(unit)}</small></div><div class="name">{text(name)}</div></div>'
                   for name, value, unit, bad in items)
    return f'<div class="cards">{body}</div>'


def table(header, rows, numeric=()):
    def cell(tag, k, value):
        return f'<{tag}{" class=n" if k in numeric else ""}>{text(value)}</{tag}>'
    head = "".join(cell("th", k, value) for k, value in enumerate(header))
    body = "".join("<tr>" + "".join(cell("td", k, value) for k, value in enumerate(row)) + "</tr>" for row in rows)
    return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"


def section(title, *parts):
    return f"<h2>{text(title)}</h2>\n" + "\n".join(parts)


def grid(*parts):
    return '<div class="grid">' + "\n".join(parts) + "</div>"


def paragraph(words, kind=""):
    return f'<p class="{kind}">{text(words)}</p>'


def write(path, title, subtitle, parts, footer):
    whole = (f'<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8"><title>{text(title)}</title>'
             '<meta name="viewport" content="width=device-width,initial-scale=1">'
             f"<style>{CSS}</style></head><body>\n<h1>{text(title)}</h1>\n"
             f'<p class="sub">{text(subtitle)}</p>\n' + "\n".join(parts)
             + f'\n<footer class="sans">{text(footer)}</footer>\n</body></html>\n')
    aside = path + ".part"   # written aside: a page that is open never shows half
    with open(aside, "w", encoding="utf-8") as file:
        file.write(whole)
    os.replace(aside, path)

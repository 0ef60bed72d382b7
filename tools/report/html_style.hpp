// The report's style sheet.
#pragma once

namespace rover::report {

inline constexpr char kStyleSheet[] = R"css(
:root{--ink:#1d2329;--muted:#66707a;--line:#e2e6ea;--soft:#f5f6f8;--good:#1f8a4c;--bad:#c62828;--warn:#b26a00}
*{box-sizing:border-box}
body{margin:0;color:var(--ink);background:#eceff1;
 font:15px/1.5 Inter,"Helvetica Neue",Helvetica,Arial,"DejaVu Sans",sans-serif}
main{max-width:1180px;margin:0 auto;background:#fff;padding:36px 40px 56px}
header{display:flex;justify-content:space-between;align-items:flex-start;gap:24px;
 border-bottom:3px solid var(--ink);padding-bottom:18px}
h1{font-size:30px;line-height:1.15;margin:0 0 6px;letter-spacing:-.01em}
h2{font-size:19px;margin:38px 0 12px;padding-top:2px}
p{margin:6px 0}
.meta{color:var(--muted);font-size:13.5px}
.badge{white-space:nowrap;font-weight:700;font-size:16px;padding:9px 18px;border-radius:6px;color:#fff}
.badge.good{background:var(--good)}.badge.bad{background:var(--bad)}
.cards{display:grid;grid-template-columns:repeat(5,1fr);gap:12px;margin:22px 0 0}
.card{background:var(--soft);border-left:4px solid #9aa5b1;padding:11px 14px 10px;border-radius:4px}
.card.good{border-color:var(--good)}.card.bad{border-color:var(--bad)}
.card b{display:block;font-size:23px;line-height:1.2;font-variant-numeric:tabular-nums}
.card span{display:block;font-size:12.5px;color:var(--muted)}
.card i{font-style:normal;font-size:14px;font-weight:500;color:var(--muted)}
svg{max-width:100%;height:auto;display:block}
.map{margin-top:22px}
.map>input{position:absolute;opacity:0}
.map>label{display:inline-block;margin:0 6px 10px 0;padding:3px 12px;border:1px solid #c3cad1;border-radius:14px;
 font-size:12.5px;color:var(--muted);cursor:pointer;user-select:none}
.map>input:checked+label{background:var(--ink);border-color:var(--ink);color:#fff}
.map>input:focus-visible+label{outline:2px solid #1458b8;outline-offset:2px}
.slope-key{display:none;font-size:12px;color:var(--muted)}#show-slope:checked~.slope-key{display:inline}
.slope-key i{display:inline-block;width:14px;height:11px;margin:0 4px 0 10px}
.timebar{display:flex;height:26px;border-radius:4px;overflow:hidden}.timebar i{flex:0 0 0;min-width:0}
.timekey{columns:3;column-gap:44px;margin:12px 0 8px;font-size:13.5px}
.timekey div{display:flex;align-items:baseline;gap:9px;padding:4px 0;border-bottom:1px solid var(--line);break-inside:avoid}
.timekey i{flex:none;width:12px;height:12px;border-radius:2px;align-self:center}.timekey span{flex:1}
.timekey b,.timekey em{font-variant-numeric:tabular-nums}.timekey em{font-style:normal;min-width:52px;text-align:right}
.timekey .none{color:var(--muted)}.timekey .none i{opacity:.35}.timekey .none b{font-weight:400}
figure{margin:0}figure svg+svg{margin-top:6px}
td.load{background:linear-gradient(to left,#cfe0f5 var(--load),transparent var(--load)) no-repeat}
.pair{display:grid;grid-template-columns:1fr 1fr;gap:18px 26px}.pair>*{min-width:0}
table.thirds{table-layout:fixed}
td.better{color:var(--good);font-weight:600}
code{font:12px "DejaVu Sans Mono",Menlo,Consolas,monospace;overflow-wrap:anywhere}
.plots svg{margin-bottom:14px}
.gallery{display:grid;grid-template-columns:repeat(3,1fr);gap:20px 22px}
table{border-collapse:collapse;width:100%;font-size:13.5px}
th{text-align:left;font-weight:600;border-bottom:2px solid var(--ink);padding:5px 10px 5px 0}
td{border-bottom:1px solid var(--line);padding:5px 10px 5px 0;vertical-align:top}
td.n,th.n{text-align:right;font-variant-numeric:tabular-nums}
td+td.good,td+td.bad,th:last-child:not(.n){padding-left:14px}td.good{color:var(--good);font-weight:600}td.bad{color:var(--bad);font-weight:600}
.two{display:grid;grid-template-columns:1fr 1fr;gap:0 44px}
details{margin:8px 0}summary{cursor:pointer;font-weight:600;font-size:14px}
pre{background:var(--soft);padding:12px 14px;font-size:12px;line-height:1.45;overflow-x:auto;border-radius:4px;
 font-family:"DejaVu Sans Mono",Menlo,Consolas,monospace;white-space:pre-wrap}
@media(max-width:820px){.cards{grid-template-columns:repeat(2,1fr)}main{padding:22px 16px}.gallery{grid-template-columns:1fr 1fr}.two{grid-template-columns:1fr}.timekey{columns:1}
 header{flex-direction:column}}
@media print{@page{size:A4;margin:12mm}body{background:#fff;font-size:11.5px}main{max-width:none;padding:0}
 *{-webkit-print-color-adjust:exact;print-color-adjust:exact}
 .map>label{display:none}header{flex-direction:row}.two{grid-template-columns:1fr 1fr;gap:0 24px}
 h2{break-after:avoid;margin-top:24px}svg,tr,.card,figure{break-inside:avoid}.cards{grid-template-columns:repeat(5,1fr)}
 .card b{font-size:17px}.card span{font-size:10.5px}table{font-size:10.5px}.meta{font-size:10.5px}
 .timekey{columns:3;column-gap:8mm;font-size:10px}.gallery{grid-template-columns:repeat(3,1fr);gap:12px 14px}
 details::details-content{content-visibility:visible;display:block}
 .configuration{break-before:page;columns:2;column-gap:8mm}.configuration h2{column-span:all}
 summary{list-style:none;break-after:avoid;font-size:10.5px}pre{font-size:7px;line-height:1.35;padding:6px 8px}}
)css";

}  // namespace rover::report

// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

namespace thermopower::io {

// Colours after Okabe and Ito, which people with any of the common colour deficiencies can tell apart; curves
// differ in dash, too. Nothing is wider than the page: below 600 px tables lose columns that repeat what stands
// elsewhere, and labels are text of the page and keep their size. On paper it is light whatever the screen.
inline constexpr const char* report_style = R"css(
:root{--paper:#fdfdfb;--ink:#1c1e21;--soft:#5b6066;--faint:#e4e4df;--card:#f4f4ef;--shade:#f3e7c4;--band:#dfe6ea;
--measured:#7d8288;--baseline:#d55e00;--augmented:#0072b2;--recalibrated:#7b5aa6;--input:#00795c;--rival1:#00795c;--rival2:#b0457f;--rival3:#8a6500;--good:#00795c;--doubt:#8a5d00;--bad:#b3261e;color-scheme:light}
@media screen and (prefers-color-scheme:dark){:root{--paper:#15171a;--ink:#e8e8e3;--soft:#a8adb3;--faint:#31353a;--card:#1e2125;--shade:#3a3420;--band:#263038;
--measured:#9aa0a6;--baseline:#ff9a4d;--augmented:#5bb8f5;--recalibrated:#b79ae0;--input:#4cc9a4;--rival1:#4cc9a4;--rival2:#f09ac6;--rival3:#e6c14c;--good:#4cc9a4;--doubt:#e3b341;--bad:#ff8a80;color-scheme:dark}}
*{box-sizing:border-box;-webkit-print-color-adjust:exact;print-color-adjust:exact}
body{margin:0;background:var(--paper);color:var(--ink);font:16px/1.5 system-ui,-apple-system,"Segoe UI",Roboto,"DejaVu Sans",sans-serif;-webkit-text-size-adjust:100%}
main{max-width:980px;margin:0 auto;padding:44px 28px 64px;overflow-wrap:anywhere}
h1{font-size:30px;line-height:1.2;margin:6px 0 10px;letter-spacing:-.01em}
h2{font-size:20px;margin:46px 0 4px}h3{font-size:16px;margin:28px 0 2px;font-weight:600}
p{margin:6px 0 12px;max-width:70ch}.soft,.lead,.from{color:var(--soft)}.words{font-size:19px;line-height:1.5;margin:12px 0 10px;max-width:62ch}.from{font-size:13px;max-width:none}.id{font-size:12.5px;color:var(--soft)}
.eyebrow{font-size:13px;letter-spacing:.07em;text-transform:uppercase;color:var(--soft)}
.explained,.no_gap{color:var(--good)}.ambiguous,.partial{color:var(--doubt)}.unexplained,.insufficient{color:var(--bad)}
.facts{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(210px,100%),1fr));gap:14px;margin:26px 0 6px}
.fact{background:var(--card);border-radius:10px;padding:14px 18px}.fact b{display:block;font-size:19px;line-height:1.3;margin:2px 0}
.fact .name{font-size:13px;color:var(--soft)}.fact .more{font-size:14px;color:var(--soft)}
.finding,.next,.where{border-left:4px solid var(--augmented);padding:2px 0 2px 16px;margin:14px 0;max-width:84ch}
.where,.finding.warning{border-color:var(--doubt)}.finding.error{border-color:var(--bad)}.finding.note{border-color:var(--faint)}
.tag{font-size:12.5px;font-weight:600;letter-spacing:.05em;text-transform:uppercase;margin-right:6px}
.warning>.tag{color:var(--doubt)}.error>.tag{color:var(--bad)}.note>.tag{color:var(--soft)}.mend{display:block}
table{border-collapse:collapse;width:100%;font-size:14.5px;margin:10px 0 8px;font-variant-numeric:tabular-nums}
th{font-weight:500;color:var(--soft);text-align:right;padding:6px 10px;border-bottom:1px solid var(--faint);vertical-align:bottom;overflow-wrap:normal}
td{text-align:right;padding:8px 10px;border-bottom:1px solid var(--faint);vertical-align:top}
th.t,td.t{text-align:left}tr>:first-child{padding-left:0}tr>:last-child{padding-right:0}td small,th small{display:block;color:var(--soft);font-size:13px;line-height:1.4}
.scores td,.scores th{width:20%}.scores .name td{border:0;padding:14px 0 0}.scores .name+tr td{padding-top:2px}
tr.chosen td{font-weight:600}tr.chosen small{font-weight:400}tr.out td{color:var(--soft)}
.bar{display:inline-block;height:9px;border-radius:2px;background:var(--augmented);vertical-align:middle}
.track{display:inline-block;width:88px;text-align:left;margin-right:8px}.nowrap{white-space:nowrap}
.score{display:block;height:7px;border-radius:2px;margin:5px 0 0;background:var(--baseline)}.scores td,.scores th{text-align:left}.scores small{white-space:nowrap}
.score.refitted{background:var(--recalibrated)}.score.after{background:var(--augmented)}.score.noise{background:var(--soft)}
code{font:14px ui-monospace,"DejaVu Sans Mono",monospace}ul{padding-left:20px;margin:8px 0}li{margin:5px 0;max-width:80ch}
figure{margin:14px 0 22px}figcaption{font-size:14px;color:var(--soft);max-width:80ch}
.chart{margin:14px 0 10px;font-size:13px;color:var(--soft)}.pair{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(380px,100%),1fr));gap:4px 26px}
.keys{display:flex;flex-wrap:wrap;gap:2px 16px;align-items:center;margin-bottom:6px}.keys .yl{color:var(--ink);margin-right:auto}
.key{color:var(--ink);white-space:nowrap}.key svg{width:24px;height:8px;margin-right:6px;vertical-align:middle}.key em{font-style:normal;display:inline-block;min-width:4em;margin-left:6px;text-align:right;font-variant-numeric:tabular-nums}
.key[aria-pressed]{cursor:pointer}.key[aria-pressed=false]{opacity:.45;text-decoration:line-through}
.bandkey{display:inline-block;width:22px;height:10px;background:var(--band);margin-right:6px}
.plot{position:relative;margin-left:52px;border-bottom:1px solid var(--soft)}.plot svg{position:absolute;width:100%;height:100%;overflow:hidden}
.xl{text-align:right;padding-top:22px;color:var(--ink);min-height:42px}.xl button{font:inherit;color:var(--augmented);background:none;border:1px solid var(--faint);border-radius:6px;padding:0 8px;margin-right:8px}
.gy{position:absolute;left:0;right:0;height:1px;background:var(--faint);z-index:-1}.gy b{position:absolute;right:100%;margin-right:7px;transform:translateY(-50%);font-weight:400;font-style:normal;white-space:nowrap}
.gx{position:absolute;bottom:-5px;width:1px;height:5px;background:var(--soft)}.gx b{position:absolute;top:5px;transform:translateX(-50%);font-weight:400;font-style:normal;white-space:nowrap}
.plot,.chart{isolation:isolate}.js .plot{touch-action:pan-y;cursor:crosshair}.cursor,.sel{position:absolute;top:0;bottom:0;pointer-events:none}.cursor{width:1px;background:var(--ink);opacity:.6}.sel{background:var(--augmented);opacity:.15}
path{vector-effect:non-scaling-stroke}.curve{fill:none;stroke-width:1.7;stroke-linejoin:round}.curve.measured{stroke:var(--measured);stroke-width:3.4;opacity:.75}
.curve.baseline{stroke:var(--baseline);stroke-dasharray:7 3}.curve.augmented,.curve.effect{stroke:var(--augmented)}.curve.effect{stroke-width:2.4}
.curve.recalibrated{stroke:var(--recalibrated);stroke-dasharray:2 3}.curve.input{stroke:var(--input)}.curve.rival1{stroke:var(--rival1);stroke-dasharray:9 2 2 2}.curve.rival2{stroke:var(--rival2);stroke-dasharray:5 2}.curve.rival3{stroke:var(--rival3);stroke-dasharray:2 2}
html:not(.js) .curve.rival1,html:not(.js) .curve.rival2,html:not(.js) .curve.rival3,html:not(.js) [data-role^=rival],html:not(.js) .switch{display:none}.curve.noise{stroke:var(--ink);stroke-dasharray:4 3}
.dots{fill:none;stroke-width:6;stroke-linecap:round}.dots.missing{stroke:var(--baseline)}.bars{fill:none;stroke-width:1.3;opacity:.6}.bars.missing{stroke:var(--baseline)}
.zero{stroke:var(--soft);fill:none}.from{stroke:var(--bad);stroke-dasharray:3 3;fill:none}.shade{fill:var(--shade)}.band{fill:var(--band)}
.no-measured .curve.measured,.no-baseline .curve.baseline,.no-recalibrated .curve.recalibrated,.no-augmented .curve.augmented,.no-effect .curve.effect,.no-input .curve.input,.no-noise .curve.noise,.no-rival1 .curve.rival1,.no-rival2 .curve.rival2,.no-rival3 .curve.rival3{display:none}
.no-baseline .key[data-role=baseline] .curve,.no-measured .key[data-role=measured] .curve,.no-recalibrated .key[data-role=recalibrated] .curve,.no-augmented .key[data-role=augmented] .curve,.js .key[data-role^=rival] .curve{display:inline}
.together td,.together th{padding:5px 4px;text-align:center;font-size:13px;white-space:nowrap}.together td:not(.t),.together th:not(.t){width:5.5em}.together td.t,.together th.t{text-align:left;white-space:normal}
td .switch{display:block;font-weight:400;font-size:13px}.switch[aria-pressed=false]{text-decoration:none}
footer{margin-top:52px;padding-top:14px;border-top:1px solid var(--faint);font-size:13.5px;color:var(--soft)}
@media (max-width:600px){main{padding:24px 16px 40px}h1{font-size:25px}h2{margin-top:36px}table{font-size:13.5px}td,th{padding-left:5px;padding-right:5px}
.together td,.together th{font-size:12px;padding:5px 1px}.together td:not(.t),.together th:not(.t){width:auto}
.track,.wide{display:none}.plot{margin-left:44px}.gx:nth-of-type(even) b{visibility:hidden}.key em{min-width:3.4em}.keys{gap:2px 12px}.keys .yl{flex-basis:100%}}
@media print{@page{margin:16mm}main{padding:0;max-width:none}body{font-size:12px}.words{font-size:15px}h1{font-size:24px}h2{margin-top:26px}
.chart,.fact,tr,.next,.where,.finding,figcaption,.keys{break-inside:avoid}h2,h3,h2+p.soft,tr.name{break-after:avoid}footer{break-before:avoid;margin-top:16px;font-size:11px}p{orphans:3;widows:3}
body{background:#fff}figure{margin:8px 0}.plot{max-height:130px}.pair{grid-template-columns:1fr 1fr}.xl button,.xl span,.key[aria-pressed=false],.switch{display:none}.chart{margin:6px 0}.xl{min-height:34px}table{font-size:12px}td,th{padding-top:4px;padding-bottom:4px}td small,th small{font-size:11px}.facts{grid-template-columns:repeat(2,1fr);gap:8px;margin:14px 0 4px}.fact{padding:8px 12px}}
)css";

}  // namespace thermopower::io

// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

namespace thermopower::gap::files {

// Colours after Okabe and Ito, which people with any of the common colour deficiencies can tell apart; curves
// differ in dash, too.
inline constexpr const char* report_style = R"css(
:root{--paper:#fdfdfb;--ink:#1c1e21;--soft:#62676d;--faint:#e4e4df;--card:#f4f4ef;--shade:#f3e7c4;
--measured:#8a8f95;--baseline:#d55e00;--augmented:#0072b2;--recalibrated:#7b5aa6;--good:#00795c;--doubt:#9a6700;--bad:#b3261e;color-scheme:light dark}
@media (prefers-color-scheme:dark){:root{--paper:#15171a;--ink:#e8e8e3;--soft:#a0a5ab;--faint:#31353a;--card:#1e2125;--shade:#3a3420;
--measured:#9aa0a6;--baseline:#ff9a4d;--augmented:#5bb8f5;--recalibrated:#b79ae0;--good:#4cc9a4;--doubt:#e3b341;--bad:#ff8a80}}
*{box-sizing:border-box}
body{margin:0;background:var(--paper);color:var(--ink);font:16px/1.5 system-ui,-apple-system,"Segoe UI",Roboto,"DejaVu Sans",sans-serif}
main{max-width:940px;margin:0 auto;padding:44px 28px 64px}
h1{font-size:30px;line-height:1.2;margin:6px 0 10px;letter-spacing:-.01em}
h2{font-size:19px;margin:46px 0 4px}h3{font-size:15px;margin:26px 0 2px;font-weight:600}
p{margin:6px 0 12px;max-width:70ch}.soft,.lead{color:var(--soft)}.lead{font-size:17px}
.eyebrow{font-size:13px;letter-spacing:.07em;text-transform:uppercase;color:var(--soft)}
.explained{color:var(--good)}.no_gap{color:var(--good)}.ambiguous,.partial{color:var(--doubt)}.unexplained,.insufficient{color:var(--bad)}
.facts{display:grid;grid-template-columns:repeat(auto-fit,minmax(200px,1fr));gap:14px;margin:26px 0 6px}
.fact{background:var(--card);border-radius:10px;padding:14px 18px}.fact b{display:block;font-size:19px;line-height:1.3;margin:2px 0;overflow-wrap:anywhere}
.fact .name{font-size:13px;color:var(--soft)}.fact .more{font-size:14px;color:var(--soft)}
table{border-collapse:collapse;width:100%;font-size:14.5px;margin:10px 0 8px;font-variant-numeric:tabular-nums}
th{font-weight:500;color:var(--soft);text-align:right;padding:6px 10px;border-bottom:1px solid var(--faint);vertical-align:bottom}
td{text-align:right;padding:8px 10px;border-bottom:1px solid var(--faint);vertical-align:top}
th.t,td.t{text-align:left}td:first-child,th:first-child{padding-left:0}td small,th small{display:block;color:var(--soft);font-size:12.5px;line-height:1.4}
tr.chosen td{font-weight:600}tr.chosen small{font-weight:400}tr.out td{color:var(--soft)}
.bar{display:inline-block;height:9px;border-radius:2px;background:var(--augmented);vertical-align:middle}
.track{display:inline-block;width:88px;text-align:left;margin-right:8px}
code{font:14px ui-monospace,"DejaVu Sans Mono",monospace}
.next{border-left:4px solid var(--augmented);padding:2px 0 2px 16px;margin:14px 0}
.where{border-left:4px solid var(--baseline);padding:2px 0 2px 16px;margin:14px 0}
ul{padding-left:20px;margin:8px 0}li{margin:5px 0;max-width:80ch}.warning{color:var(--doubt)}.error{color:var(--bad)}
figure{margin:14px 0 22px}figcaption{font-size:13.5px;color:var(--soft);max-width:76ch}
svg{display:block;width:100%;height:auto;overflow:visible}
svg text{font:12px system-ui,-apple-system,"Segoe UI",Roboto,"DejaVu Sans",sans-serif;fill:var(--soft)}
svg text.label,svg text.key{fill:var(--ink)}
.grid{stroke:var(--faint);stroke-width:1}.mark,.axis{stroke:var(--soft);stroke-width:1}.shade{fill:var(--shade)}
.curve{fill:none;stroke-width:1.7;stroke-linejoin:round}.curve.measured{stroke:var(--measured);stroke-width:3.2;opacity:.75}
.curve.baseline{stroke:var(--baseline);stroke-dasharray:7 3}.curve.augmented,.curve.effect{stroke:var(--augmented)}.curve.effect{stroke-width:2.4}
.curve.recalibrated{stroke:var(--recalibrated);stroke-dasharray:2 3}
.dots.measured{fill:var(--measured)}.dots.missing{fill:var(--baseline)}.bars line{stroke:var(--baseline);stroke-width:1.3;opacity:.6}
.gapline{stroke:var(--faint);stroke-width:6;stroke-linecap:round}.d-before{fill:var(--baseline)}.d-recalibrated{fill:var(--recalibrated)}.d-after{fill:var(--augmented)}
.d-floor{stroke:var(--ink);stroke-width:2}.ci{stroke:var(--augmented);stroke-width:3;opacity:.5}
footer{margin-top:52px;padding-top:14px;border-top:1px solid var(--faint);font-size:13.5px;color:var(--soft)}
@media print{main{padding:0;max-width:none}body{font-size:12px}figure,.fact,tr,.next,.where{break-inside:avoid}h2{break-after:avoid}}
)css";

}  // namespace thermopower::gap::files

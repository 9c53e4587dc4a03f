#pragma once

namespace curvewright {

/// The style sheet of a report.
inline constexpr const char* report_style = R"(
:root { color-scheme: light; }
* { box-sizing: border-box; }
body { margin: 0; background: #ffffff; color: #1d2125; font: 15px/1.5 system-ui, "Segoe UI", "Noto Sans", "DejaVu Sans", sans-serif;
  font-variant-numeric: tabular-nums; }
main { max-width: 1000px; margin: 0 auto; padding: 32px 24px 48px; }
h1 { margin: 0 0 16px; font-size: 28px; line-height: 1.25; overflow-wrap: anywhere; }
h2 { margin: 40px 0 12px; padding-bottom: 4px; font-size: 20px; border-bottom: 1px solid #d5d9de; break-after: avoid; }
h3 { margin: 20px 0 8px; font-size: 15px; break-after: avoid; }
p { margin: 8px 0; max-width: 76ch; }
.kicker { margin: 0; color: #565d66; font-size: 13px; letter-spacing: .06em; text-transform: uppercase; }
.note { color: #565d66; font-size: 13px; }
.verdict { display: flex; gap: 16px; align-items: flex-start; padding: 16px 20px; border: 1px solid; border-left-width: 6px; border-radius: 6px;
  break-inside: avoid; }
.verdict p { margin: 0; font-size: 18px; line-height: 1.45; }
.verdict .mark { font-size: 26px; line-height: 1; font-weight: 700; }
.good { border-color: #2f7d4f; background: #f0f8f3; } .good .mark { color: #2f7d4f; }
.bad { border-color: #b0003f; background: #fdf1f5; } .bad .mark { color: #b0003f; }
.facts { display: grid; grid-template-columns: repeat(4, 1fr); gap: 12px; margin: 16px 0 0; }
.facts div { padding: 10px 14px; background: #f5f6f8; border-radius: 6px; break-inside: avoid; }
.facts dt { color: #565d66; font-size: 13px; } .facts dd { margin: 0; font-size: 18px; font-weight: 600; }
table { border-collapse: collapse; width: 100%; font-size: 14px; }
th { text-align: left; color: #565d66; font-weight: 600; font-size: 13px; vertical-align: bottom; }
th, td { padding: 5px 10px 5px 0; border-bottom: 1px solid #e3e5e8; }
td { vertical-align: top; overflow-wrap: anywhere; }
.number { text-align: right; white-space: nowrap; padding-right: 16px; }
tr { break-inside: avoid; }
thead { display: table-header-group; }
.pair { display: grid; grid-template-columns: 1fr 1fr; gap: 16px; }
.triple { display: grid; grid-template-columns: 1fr 1fr 1fr; gap: 16px; }
figure { margin: 0; break-inside: avoid; }
figure img { display: block; width: 100%; border: 1px solid #d5d9de; border-radius: 4px; }
figcaption { margin-top: 4px; color: #565d66; font-size: 13px; }
.chart { display: block; width: 100%; height: auto; font: 11px system-ui, "Segoe UI", "Noto Sans", "DejaVu Sans", sans-serif; fill: #565d66; }
.chart .strong { font-weight: 600; fill: #1d2125; }
.legend { display: flex; flex-wrap: wrap; gap: 4px 20px; margin: 8px 0; color: #565d66; font-size: 13px; }
.swatch { display: inline-block; width: 12px; height: 12px; margin-right: 6px; vertical-align: -1px; border: 1px solid rgba(0,0,0,.25); border-radius: 2px; }
.ramp { width: 96px; } .card { margin: 16px 0; break-inside: avoid; }
.tag { font-weight: 600; }
code, .mono { font-family: ui-monospace, "DejaVu Sans Mono", monospace; font-size: 13px; overflow-wrap: anywhere; }
pre { margin: 8px 0; padding: 10px 14px; background: #f5f6f8; border-radius: 6px; white-space: pre-wrap; overflow-wrap: anywhere; font-size: 13px; }
footer { margin-top: 40px; color: #565d66; font-size: 13px; }
@media (max-width: 720px) { .pair, .triple { grid-template-columns: 1fr; } .facts { grid-template-columns: 1fr 1fr; } }
@media print {
  @page { size: A4; margin: 14mm; }
  body { font-size: 10.5pt; -webkit-print-color-adjust: exact; print-color-adjust: exact; }
  main { max-width: none; padding: 0; }
  h2 { margin-top: 24px; }
  table { font-size: 9.5pt; }
}
)";

}  // namespace curvewright

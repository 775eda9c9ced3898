#include "telltale/client/report/style.hpp"

namespace telltale {

std::string_view Style() {
  return R"(
:root {
  color-scheme: light dark;
  --paper: #fdfdfc; --ink: #1c2126; --soft: #566069; --line: #d8dcdf; --card: #f4f5f4;
  --before: #c75300; --after: #0068a8; --heat: 213 94 0;
  --floor: #7b858d; --band: rgb(110 125 135 / .16); --onset: rgb(140 90 170 / .2);
  --onset-ink: #7a3e9d;
}
@media (prefers-color-scheme: dark) {
  :root {
    --paper: #14181b; --ink: #e8eaeb; --soft: #a5afb6; --line: #363d43; --card: #1c2125;
    --before: #f29441; --after: #62b4ee; --heat: 225 112 20;
    --floor: #98a2a9; --band: rgb(150 165 175 / .16); --onset: rgb(190 140 220 / .22);
    --onset-ink: #d0a2ea;
  }
}
*, *::before, *::after { box-sizing: border-box; }
html { font-size: 17px; -webkit-text-size-adjust: 100%; text-size-adjust: 100%; }
body {
  margin: 0; background: var(--paper); color: var(--ink);
  font: 1rem/1.55 system-ui, -apple-system, "Segoe UI", Roboto, "Helvetica Neue", sans-serif;
  font-variant-numeric: tabular-nums; overflow-wrap: anywhere;
}
main { max-width: 64rem; margin: 0 auto; padding: 2.5rem 1.25rem 4rem; }
h1, h2 {
  font-family: ui-serif, "Iowan Old Style", "Palatino Linotype", Palatino, Georgia, serif;
  font-weight: 600; letter-spacing: -.01em; text-wrap: balance;
}
h1 { font-size: clamp(1.55rem, 1.1rem + 2.2vw, 2.4rem); line-height: 1.22; margin: .6rem 0 1.1rem; }
h2 { font-size: 1.45rem; line-height: 1.3; margin: 0 0 .3rem; }
h3 { font-size: 1rem; margin: 0 0 .3rem; }
p { margin: 0 0 .8rem; max-width: 40rem; }
section { border-top: 1px solid var(--line); padding-top: 1.6rem; margin-top: 2.4rem; }
small, .soft, figcaption, caption, .legend, dt, .kicker { font-size: .875rem; }
.soft, figcaption, caption, .legend, dt, .kicker, .nothing { color: var(--soft); }
.kicker { margin: 0; }
.badge {
  display: inline-block; padding: .15rem .75rem; border-radius: 2rem; font-weight: 650;
  border: 2px solid currentColor; margin-right: .6rem;
}
.badge.calm { color: var(--after); }
.badge.alert { color: var(--before); }
.badge.mute { color: var(--soft); }
.meaning { font-size: 1.06rem; }
.nothing { font-style: italic; }
.legend { display: flex; flex-wrap: wrap; gap: .3rem 1.3rem; margin: .4rem 0 1rem; }
.key { display: inline-flex; align-items: center; gap: .5rem; }
.swatch { width: 1.6rem; height: 0; border-top: 3px solid; flex: none; }
.swatch.before { border-color: var(--before); border-top-style: dashed; }
.of-bars .swatch { border-top-width: 7px; }
.of-bars .swatch.before { border-top-style: solid; }
.of-bars .swatch.floor { border-top-width: 2px; }
.swatch.after { border-color: var(--after); }
.swatch.measured { border-color: var(--ink); }
.swatch.floor { height: .9rem; border-top: 2px solid var(--floor); background: var(--band); }

.columns { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(19rem, 100%), 1fr)); gap: 1.2rem 1.5rem; }
.halves { margin-top: 1.6rem; display: grid; grid-template-columns: repeat(2, minmax(0, 1fr));
  gap: 1.2rem 2.6rem; }
.bar-row { display: grid; grid-template-columns: 1fr auto; align-items: baseline; margin: .55rem 0; }
.bar-row .bars { grid-column: 1 / -1; }
.bars { display: block; width: 100%; height: 22px; background: var(--card); }
.bar-row .name { white-space: nowrap; padding-right: .6rem; }
.figures { text-align: right; }
.figures span { white-space: nowrap; }
.figures .soft { margin-left: .5rem; }
.before-text { color: var(--before); }
.after-text { color: var(--after); }

.picture { display: block; width: 100%; height: auto; overflow: hidden; }
.picture text { font-size: 14px; fill: var(--soft); }
.picture .strong { fill: var(--ink); font-weight: 650; }
.picture .faint { opacity: .6; }
.picture .halo { fill: var(--ink); paint-order: stroke; stroke: var(--paper); stroke-width: 4px; }
.picture.narrow, .picture.medium { display: none; }
.picture.rose { max-width: 25rem; margin: 0 auto; }
.picture.whiskers { max-width: 22rem; }
.grid { stroke: var(--line); }
.ring { fill: none; stroke: var(--line); }
.pointed { fill: transparent; }
.pointed:hover { fill: var(--band); }
.floor-band { fill: var(--band); }
.floor-line { stroke: var(--floor); stroke-width: 2; vector-effect: non-scaling-stroke; }
.onset-band { fill: var(--onset); }
.onset-line { stroke: var(--onset-ink); stroke-width: 2; }
.before-bar { fill: var(--before); }
.after-bar { fill: var(--after); }
.before-trace, .after-trace { fill: none; stroke-width: 1.25; stroke-linejoin: round; opacity: .55; }
.before-trace { stroke: var(--before); stroke-dasharray: 4 3; }
.after-trace { stroke: var(--after); }
.dense { opacity: 1; }
.before-dot { fill: var(--paper); stroke: var(--before); stroke-width: 1.75; }
.after-dot { fill: var(--after); }
.before-wedge { fill: rgb(var(--heat) / .3); stroke: var(--before); stroke-width: 1.5; }
.after-wedge { fill: var(--after); }
.track { fill: var(--line); }
.ink-bar { fill: var(--ink); }
.whisker { stroke: var(--after); stroke-width: 3; }
.whisker-dot { fill: var(--after); stroke: var(--paper); stroke-width: 2; }
.measured-path, .before-path, .after-path {
  fill: none; stroke-width: 2.5; stroke-linecap: round; stroke-linejoin: round;
}
.measured-path { stroke: var(--ink); stroke-width: 4; opacity: .8; }
.before-path { stroke: var(--before); stroke-dasharray: 7 5; }
.after-path { stroke: var(--after); }
.measured-end { fill: var(--ink); }
.before-end { fill: var(--before); }
.after-end { fill: var(--after); }
.start { fill: var(--paper); stroke: var(--ink); stroke-width: 2; }
.scale { stroke: var(--soft); stroke-width: 2; }
.arrow { fill: none; stroke: var(--soft); stroke-width: 2; }

table { border-collapse: collapse; width: 100%; }
caption { text-align: left; padding-bottom: .5rem; }
th, td { padding: .4rem .5rem; text-align: left; border-bottom: 1px solid var(--line); }
th { font-weight: 600; }
thead th { font-size: .875rem; color: var(--soft); vertical-align: bottom; }
th, .number { overflow-wrap: normal; }
td:first-child { overflow-wrap: break-word; }
th:first-child, td:first-child { padding-left: 0; }
th:last-child, td:last-child { padding-right: 0; }
.number { text-align: right; }
td.number { white-space: nowrap; }
tbody small { display: block; color: var(--soft); }
.group th { padding-top: 1rem; color: var(--soft); font-size: .875rem; }
.map { table-layout: fixed; }
.map td { text-align: center; padding: .45rem .1rem; border: 2px solid var(--paper); }
.map thead th { text-align: center; }
.map thead th:first-child { text-align: left; }
.map tbody th { border: 0; font-size: .875rem; white-space: nowrap; }
.map b, .map span { display: block; line-height: 1.3; }
.map .empty { color: var(--soft); background: var(--card); }
.map small { color: inherit; }

.cards, .paths { display: grid; gap: 1.2rem; }
.cards { grid-template-columns: repeat(auto-fit, minmax(min(18rem, 100%), 1fr)); align-items: start; }
.paths { grid-template-columns: repeat(auto-fill, minmax(min(18rem, 100%), 1fr)); }
.card { background: var(--card); border-radius: .6rem; padding: 1rem 1.15rem; }
.card > :last-child { margin-bottom: 0; }
.card header { display: flex; justify-content: space-between; gap: 1rem; align-items: baseline; }
.share { font-size: 1.3rem; white-space: nowrap; }
.probability { display: block; width: 100%; height: 6px; margin: .1rem 0 .8rem; }
.says { font-size: 1.06rem; margin-bottom: .3rem; }
.unlikely { margin-top: 1rem; }
.tied { border-left: 3px solid var(--before); padding-left: .7rem; }
dl { display: grid; grid-template-columns: auto 1fr; gap: .1rem .9rem; margin: 0 0 .8rem; }
dd { margin: 0; text-align: right; }
figure { margin: 0; background: var(--card); border-radius: .6rem; padding: .6rem .6rem .7rem; }
figcaption { text-align: center; }
footer { border-top: 1px solid var(--line); margin-top: 2.4rem; padding-top: 1rem; }
ul { padding-left: 1.2rem; margin: 0; max-width: 40rem; }
li { margin-bottom: .4rem; }

@media (max-width: 1000px) {
  .picture.wide { display: none; }
  .picture.medium { display: block; }
}
@media (max-width: 700px) {
  main { padding: 1.4rem 1rem 3rem; }
  .halves { grid-template-columns: minmax(0, 1fr); }
  .picture.medium { display: none; }
  .picture.narrow { display: block; }
  th:not(:first-child), td:not(:first-child) { padding-left: .3rem; }
  th:not(:last-child), td:not(:last-child) { padding-right: .3rem; }
}
@media print { section { break-inside: avoid; } }
)";
}

}  // namespace telltale

import { useEffect, useRef } from "preact/hooks";
import uPlot from "uplot";
import "uplot/dist/uPlot.min.css";
import type { Coefficient, History, Model } from "./api";
import { clock, clockMinute, number, regressor, significant, unit } from "./format";

/** Where the drift monitor calls a model's error an error; docs/reference/quality.md. */
const kErrorRatio = 3;

/** A line at the normal error, and shade where a drifting model is in error. */
function drawLimits(chart: uPlot, colour: (name: string) => string) {
  const { left, top, width, height } = chart.bbox;
  const context = chart.ctx;
  const ratio = window.devicePixelRatio || 1;
  const at = (value: number) => chart.valToPos(value, "y", true);
  context.save();
  context.beginPath();
  context.rect(left, top, width, height);
  context.clip();
  context.font = `${12 * ratio}px system-ui, sans-serif`;
  context.textAlign = "right";
  context.textBaseline = "alphabetic";
  context.fillStyle = colour("--error");
  context.globalAlpha = 0.12;
  context.fillRect(left, top, width, Math.max(0, at(kErrorRatio) - top));
  context.globalAlpha = 1;
  if (at(kErrorRatio) > top + 16 * ratio) {
    context.fillText("ERROR where it drifts", left + width - 8 * ratio, at(kErrorRatio) - 6 * ratio);
  }
  context.strokeStyle = context.fillStyle = colour("--ok");
  context.lineWidth = 1.5 * ratio;
  context.setLineDash([6 * ratio, 4 * ratio]);
  context.beginPath();
  context.moveTo(left, at(1));
  context.lineTo(left + width, at(1));
  context.stroke();
  const below = at(1) + 15 * ratio;
  context.fillText("normal error", left + width - 8 * ratio, below < top + height ? below : at(1) - 5 * ratio);
  context.restore();
}

const kTickStepsS = [1, 5, 10, 15, 30, 60, 120, 300, 600, 900, 1800];  // of an hour at most

/** Room for "12:34", or for "12:34:56" where ticks are less than a minute apart. */
function tickSpace(_chart: uPlot, _axis: number, fromS: number, toS: number, widthPx: number): number {
  const secondsAtLeast = (45 * (toS - fromS)) / widthPx;
  return secondsAtLeast > 30 ? 45 : 75;
}

function tickTexts(_chart: uPlot, times: number[], _axis: number, _space: number, stepS: number): string[] {
  return times.map((time) => (stepS < 60 ? clock(time) : clockMinute(time)));
}

function errorOptions(element: HTMLElement, colour: (name: string) => string): uPlot.Options {
  const axis = { stroke: colour("--muted"), grid: { stroke: colour("--line"), width: 1 },
                 ticks: { stroke: colour("--line"), width: 1 } };
  return {
    width: element.clientWidth,
    height: 230,
    padding: [12, 24, 0, 0],  // half a tick's text beyond the last tick
    legend: { live: true },
    cursor: { drag: { x: false, y: false } },
    scales: {
      x: { time: true },
      y: { range: (_chart, _low, high) => [0, Math.max(1.5, 1.15 * (high ?? 0))] },
    },
    axes: [
      { ...axis, incrs: kTickStepsS, space: tickSpace, values: tickTexts },
      { ...axis, label: "times the normal error", size: 46, labelSize: 20 },
    ],
    series: [
      { label: "time", value: (_chart, time) => (time == null ? "–" : clock(time)) },
      {
        label: "free-run error",
        stroke: colour("--accent"),
        width: 2,
        points: { show: false },
        value: (_chart, value) => (value == null ? "–" : `${significant(value)} ×`),
      },
    ],
    hooks: { drawAxes: [(chart) => drawLimits(chart, colour)] },
  };
}

/** The free-run error of the last hour. */
export function ErrorChart({ history }: { history: History }) {
  const known = history.predictionError.filter((error) => error > 0);
  return known.length === 0
    ? <p class="empty">No error yet: it needs a model and a minute of telemetry.</p>
    : <ErrorLine history={history} now={known.at(-1) ?? NaN} />;
}

function ErrorLine({ history, now }: { history: History; now: number }) {
  const element = useRef<HTMLDivElement>(null);
  const chart = useRef<uPlot>();
  const data: uPlot.AlignedData = [
    history.timeUnixS,
    history.predictionError.map((error) => (error > 0 ? error : null)),
  ];
  const latest = useRef(data);
  latest.current = data;
  useEffect(() => {
    const host = element.current;
    if (!host) return;
    const make = () => {
      chart.current?.destroy();
      const style = getComputedStyle(host);
      const colour = (name: string) => style.getPropertyValue(name).trim();
      chart.current = new uPlot(errorOptions(host, colour), latest.current, host);
    };
    make();
    const observer = new ResizeObserver(() =>
      chart.current?.setSize({ width: host.clientWidth, height: 230 }));
    observer.observe(host);
    const scheme = matchMedia("(prefers-color-scheme: dark)");
    scheme.addEventListener("change", make);
    return () => {
      observer.disconnect();
      scheme.removeEventListener("change", make);
      chart.current?.destroy();
      chart.current = undefined;
    };
  }, []);
  useEffect(() => chart.current?.setData(data));
  return <div ref={element} class="chart" role="img"
    aria-label={`Free-run error over time; now ${significant(now)} times the normal error`} />;
}

interface Revision {
  revision: number;
  coefficient?: Coefficient;
}

const isKnown = (coefficient?: Coefficient): coefficient is Coefficient =>
  coefficient !== undefined && coefficient.status === "ESTIMATED" &&
  Number.isFinite(number(coefficient.interval?.lower)) &&
  Number.isFinite(number(coefficient.interval?.upper));

/** One coefficient: its intervals from revision to revision, the newest at the right. */
function IntervalRow({ name, past }: { name: string; past: Revision[] }) {
  const known = past.filter((entry) => isKnown(entry.coefficient));
  const newest = past.at(-1)?.coefficient;
  const [width, height, margin] = [220, 44, 7];
  const bounds = known.map(({ coefficient }) =>
    [number(coefficient?.interval?.lower), number(coefficient?.interval?.upper)] as const);
  const low = Math.min(...bounds.map(([lower]) => lower));
  const high = Math.max(...bounds.map(([, upper]) => upper));
  const y = (value: number) =>
    height - margin - ((value - low) / (high - low || 1)) * (height - 2 * margin);
  const x = (index: number) => margin + ((index + 0.5) * (width - 2 * margin)) / Math.max(past.length, 1);
  return (
    <tr>
      <th scope="row"><span class="symbol">{newest?.symbol || name}</span> <span class="muted words">{regressor(name)}</span></th>
      <td class="intervals">
        <svg viewBox={`0 0 ${width} ${height}`} role="img"
          aria-label={`${name}: ${known.length} of ${past.length} revisions with bounds`}>
          {low < 0 && high > 0 && <line class="zero" x1="0" x2={width} y1={y(0)} y2={y(0)} />}
          {past.map(({ revision, coefficient }, index) => {
            if (!isKnown(coefficient)) return null;
            const lower = number(coefficient.interval?.lower);
            const upper = number(coefficient.interval?.upper);
            const isNewest = index === past.length - 1;
            return (
              <g key={revision} class={isNewest ? "newest" : "older"}>
                <title>{`revision ${revision}: ${significant(coefficient.estimate)} [${significant(lower)}, ${significant(upper)}] ${unit(coefficient.unit)}`}</title>
                <line x1={x(index)} x2={x(index)} y1={y(lower)} y2={y(upper)} />
                <circle cx={x(index)} cy={y(coefficient.estimate)} r="3" />
              </g>
            );
          })}
        </svg>
      </td>
      <td class="number estimate">{isKnown(newest) ? significant(newest.estimate) : "not identified"}</td>
      <td class="number muted bounds">
        {isKnown(newest) &&
          `[${significant(number(newest.interval?.lower))}, ${significant(number(newest.interval?.upper))}] ${unit(newest.unit)}`}
      </td>
    </tr>
  );
}

/** The coefficients of one equation, by rows, over the models, newest first in `models`. */
export function Intervals({ models, equation }: { models: Model[]; equation: string }) {
  const inTime = [...models].reverse();
  const newest = models[0];
  if (!newest) return null;
  const rows = newest.coefficients.filter((coefficient) => coefficient.equation === equation);
  return (
    <div class="scroll">
      <table class="coefficients">
        <thead>
          <tr>
            <th scope="col">coefficient</th>
            <th scope="col">{inTime.length > 1
              ? `revisions ${inTime[0]?.provenance.revision} to ${newest.provenance.revision}`
              : `revision ${newest.provenance.revision}`}</th>
            <th scope="col" class="number">estimate</th>
            <th scope="col" class="number">{`${100 * (rows[0]?.interval?.level ?? 0.95)} % bounds`}</th>
          </tr>
        </thead>
        <tbody>
          {rows.map((row) => (
            <IntervalRow key={row.regressor} name={row.regressor}
              past={inTime.map((model) => ({
                revision: Number(model.provenance.revision),
                coefficient: model.coefficients.find((other) =>
                  other.equation === equation && other.regressor === row.regressor),
              }))} />
          ))}
        </tbody>
      </table>
    </div>
  );
}

import type { Path, PredictedPaths } from "./api";
import { duration, number, significant } from "./format";
import { roundLength } from "./map";

const kWidth = 480;
const kHeight = 300;
const kMargin = 14;
const kLeastSpanM = 5;  // so that a boat at rest does not fill the plot with noise

interface Frame {
  x: (eastM: number) => number;
  y: (northM: number) => number;
  gridM: number;
}

const extent = (values: number[]): [number, number] => [Math.min(...values), Math.max(...values)];

/** Both axes on one scale, north up, about all paths. A path that leaves the measured one far behind is cut off. */
function frameOf({ measured, predicted }: PredictedPaths): Frame {
  const [west, east] = extent(measured.eastM);
  const [south, north] = extent(measured.northM);
  const reach = Math.max(kLeastSpanM, east - west, north - south);
  const within = (values: number[], low: number, high: number) =>
    values.map((value) => Math.min(high + reach, Math.max(low - reach, value)));
  const easts = within([...measured.eastM, ...predicted.flatMap((path) => path.eastM)], west, east);
  const norths = within([...measured.northM, ...predicted.flatMap((path) => path.northM)], south, north);
  const [left, right] = extent(easts);
  const [bottom, top] = extent(norths);
  const scale = Math.min((kWidth - 2 * kMargin) / Math.max(kLeastSpanM, right - left),
                         (kHeight - 2 * kMargin) / Math.max(kLeastSpanM, top - bottom));
  return {
    x: (eastM) => kWidth / 2 + (eastM - (left + right) / 2) * scale,
    y: (northM) => kHeight / 2 - (northM - (bottom + top) / 2) * scale,
    gridM: roundLength(90 / scale),
  };
}

function Grid({ frame }: { frame: Frame }) {
  const step = frame.x(frame.gridM) - frame.x(0);
  const lines = (origin: number, end: number) => {
    const first = ((origin % step) + step) % step;
    return Array.from({ length: Math.max(0, Math.ceil((end - first) / step)) }, (_, i) => first + i * step);
  };
  return (
    <g class="grid">
      {lines(frame.x(0), kWidth).map((x) => <line key={`x${x}`} x1={x} x2={x} y1={0} y2={kHeight} />)}
      {lines(frame.y(0), kHeight).map((y) => <line key={`y${y}`} x1={0} x2={kWidth} y1={y} y2={y} />)}
    </g>
  );
}

function Line({ path, frame, name }: { path: Path; frame: Frame; name: string }) {
  const points = path.eastM.map((eastM, i) => `${frame.x(eastM).toFixed(1)},${frame.y(path.northM[i] ?? 0).toFixed(1)}`);
  return <polyline class={name} points={points.join(" ")} />;
}

/** From where a run ends to where the boat was then. */
function EndError({ path, measured, frame }: { path: Path; measured: Path; frame: Frame }) {
  const end = path.timeS.length - 1;
  const time = path.timeS[end];
  const at = measured.timeS.findIndex((other) => time !== undefined && other >= time - 1e-6);
  if (end < 0 || at < 0) return null;
  const [x, y] = [frame.x(path.eastM[end] ?? 0), frame.y(path.northM[end] ?? 0)];
  return (
    <>
      <line class="end-error" x1={x} y1={y} x2={frame.x(measured.eastM[at] ?? 0)} y2={frame.y(measured.northM[at] ?? 0)} />
      <circle class="predicted-end" cx={x} cy={y} r="4" />
    </>
  );
}

function Start({ path, frame }: { path: Path; frame: Frame }) {
  return <circle class="start" cx={frame.x(path.eastM[0] ?? 0)} cy={frame.y(path.northM[0] ?? 0)} r="4" />;
}

/** Where the boat went, and where its model says that the commands alone take it. */
export function PathPlot({ paths }: { paths: PredictedPaths }) {
  const frame = frameOf(paths);
  const errorM = number(paths.positionRmseM);
  const horizon = duration(paths.horizonS);
  const outcome = Number.isFinite(errorM)
    ? `After ${horizon} the model is ${significant(errorM, 2)} m off${paths.predicted.length > 1
        ? ` (root mean square of ${paths.predicted.length} runs)` : ""}.`
    : `The model diverges within ${horizon}.`;
  return (
    <>
      <svg class="paths" viewBox={`0 0 ${kWidth} ${kHeight}`} role="img" aria-label={`Measured and predicted path, north up. ${outcome}`}>
        <Grid frame={frame} />
        <Line path={paths.measured} frame={frame} name="measured" />
        {paths.predicted.map((path, i) => <Line key={i} path={path} frame={frame} name="predicted" />)}
        {paths.predicted.map((path, i) => <EndError key={i} path={path} measured={paths.measured} frame={frame} />)}
        {paths.predicted.map((path, i) => <Start key={i} path={path} frame={frame} />)}
      </svg>
      <p class="legend">
        <span class="key measured">measured</span>
        <span class="key predicted">predicted from the commands alone</span>
        <span class="muted">north up, grid {significant(frame.gridM)} m</span>
      </p>
      <p>{outcome} Each run starts from the measured state at a ring.</p>
    </>
  );
}

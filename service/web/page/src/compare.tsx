import { useState } from "preact/hooks";
import type { Coefficient, Comparison, Model } from "./api";
import { number, regressor, significant, unit, words } from "./format";
import { useAnswer } from "./use_answer";

const kRowsAtOnce = 8;

/** What the test compares: parameters of the physical form, else coefficients and the lag. */
function comparedIn(model?: Model): Coefficient[] {
  if (!model) return [];
  if (model.structure === "FOSSEN") return model.parameters ?? [];
  const lag = model.thrusterTimeConstantS;
  return lag ? [...model.coefficients, lag] : model.coefficients;
}

type Named = Pick<Coefficient, "equation" | "regressor" | "symbol">;

const keyOf = ({ equation, regressor, symbol }: Named) => `${equation} ${regressor} ${regressor ? "" : symbol}`;

interface Pair {
  of: Coefficient;
  earlier?: Coefficient;
  sigmas?: number;
  pValue?: number;
}

/** Everything the later model has, as the test orders it: the most significant difference first. */
function pairsOf(comparison: Comparison, earlier?: Model, later?: Model): Pair[] {
  const before = new Map(comparedIn(earlier).map((coefficient) => [keyOf(coefficient), coefficient]));
  const places = new Map(comparison.change.coefficients.map((change, place) => [keyOf(change), place]));
  const placeOf = (of: Coefficient) => places.get(keyOf(of)) ?? Infinity;
  return [...comparedIn(later)]
    .sort((a, b) => (placeOf(a) === placeOf(b) ? 0 : placeOf(a) - placeOf(b)))
    .map((of) => {
      const change = comparison.change.coefficients[placeOf(of)];
      return { of, earlier: before.get(keyOf(of)),
               sigmas: change && change.difference / change.standardError, pValue: change?.pValue };
    });
}

function boundsOf(coefficient?: Coefficient): [number, number] | null {
  const lower = number(coefficient?.interval?.lower);
  const upper = number(coefficient?.interval?.upper);
  return Number.isFinite(lower) && Number.isFinite(upper) ? [lower, upper] : null;
}

function Value({ coefficient }: { coefficient?: Coefficient }) {
  const bounds = boundsOf(coefficient);
  if (!coefficient || !bounds) return <>not identified</>;
  return (
    <>{significant(coefficient.estimate)} <span class="muted">[{significant(bounds[0])}, {significant(bounds[1])}]</span></>
  );
}

/** Two intervals on one scale, the earlier above. */
function TwoIntervals({ pair }: { pair: Pair }) {
  const [width, height, margin] = [160, 26, 6];
  const known = [pair.earlier, pair.of].map(boundsOf);
  const ends = known.flatMap((bounds) => bounds ?? []);
  if (ends.length === 0) return null;
  const [low, high] = [Math.min(...ends), Math.max(...ends)];
  const x = (value: number) => margin + ((value - low) / (high - low || 1)) * (width - 2 * margin);
  return (
    <svg viewBox={`0 0 ${width} ${height}`} aria-hidden="true">
      {[pair.earlier, pair.of].map((coefficient, index) => {
        const bounds = known[index];
        if (!coefficient || !bounds) return null;
        const y = index === 0 ? 8 : 18;
        return (
          <g key={index} class={index === 0 ? "older" : "newest"}>
            <line x1={x(bounds[0])} x2={x(bounds[1])} y1={y} y2={y} />
            <circle cx={x(coefficient.estimate)} cy={y} r="3" />
          </g>
        );
      })}
    </svg>
  );
}

function PairRow({ pair }: { pair: Pair }) {
  const { of, sigmas, pValue } = pair;
  const equation = of.equation === "UNKNOWN_EQUATION" ? "" : words(of.equation);
  return (
    <tr>
      <th scope="row"><span class="symbol">{of.symbol}</span> <span class="muted words">{equation} {regressor(of.regressor)}</span></th>
      <td class="intervals"><TwoIntervals pair={pair} /></td>
      <td class="number" data-name="earlier"><Value coefficient={pair.earlier} /></td>
      <td class="number" data-name="later"><Value coefficient={of} /></td>
      <td class="muted unit">{unit(of.unit)}</td>
      <td class={pValue !== undefined && pValue < 0.01 ? "number differs" : "number"} data-name="difference">
        {sigmas === undefined ? "–" : `${sigmas > 0 ? "+" : ""}${sigmas.toFixed(1).replace("-", "\u2212")} σ`}</td>
    </tr>
  );
}

function Pairs({ comparison, pairs }: { comparison: Comparison; pairs: Pair[] }) {
  const [all, setAll] = useState(false);
  return (
    <>
      <div class="scroll">
        <table class="pairs">
          <thead>
            <tr>
              <th scope="col">{comparison.change.coefficients.length > 0 ? "most significant first" : "coefficient"}</th>
              <th scope="col">bounds</th>
              <th scope="col" class="number">revision {comparison.earlier}</th>
              <th scope="col" class="number">revision {comparison.later}</th>
              <th scope="col">unit</th>
              <th scope="col" class="number">difference</th>
            </tr>
          </thead>
          <tbody>
            {(all ? pairs : pairs.slice(0, kRowsAtOnce)).map((pair) => <PairRow key={keyOf(pair.of)} pair={pair} />)}
          </tbody>
        </table>
      </div>
      {!all && pairs.length > kRowsAtOnce &&
        <button type="button" class="more" onClick={() => setAll(true)}>Show all {pairs.length}</button>}
    </>
  );
}

function RevisionChoice({ name, value, revisions, choose }: {
  name: string;
  value: string;
  revisions: string[];
  choose: (revision: string) => void;
}) {
  return (
    <label>{name} <select value={value} onChange={(event) => choose(event.currentTarget.value)}>
      {revisions.map((revision) => <option key={revision} value={revision}>{revision}</option>)}
    </select></label>
  );
}

/** Whether two revisions differ by more than their errors, with their bounds side by side. */
export function CompareModels({ vehicleId, models }: { vehicleId: string; models: Model[] }) {
  const [chosen, choose] = useState<{ earlier?: string; later?: string }>({});
  const revisions = models.map((model) => model.provenance.revision);  // the newest first
  const later = chosen.later ?? revisions[0] ?? "";
  const older = revisions.filter((revision) => Number(revision) < Number(later));
  const earlier = chosen.earlier && older.includes(chosen.earlier) ? chosen.earlier : older[0] ?? "";
  const { answer, fault } = useAnswer<Comparison>(
    `/vehicles/${encodeURIComponent(vehicleId)}/comparison?earlier=${earlier}&later=${later}`, later);
  const find = (revision?: number) => models.find((model) => Number(model.provenance.revision) === revision);
  return (
    <>
      <h3>Compare</h3>
      <form class="orders" onSubmit={(event) => event.preventDefault()}>
        <RevisionChoice name="Revision" value={later} revisions={revisions.slice(0, -1)}
          choose={(revision) => choose({ ...chosen, later: revision })} />
        <RevisionChoice name="with revision" value={earlier} revisions={older}
          choose={(revision) => choose({ ...chosen, earlier: revision })} />
      </form>
      {fault && <p class="fault" role="alert">{fault}</p>}
      {answer && <>
        <p class="answer" role="status">{answer.sentence}</p>
        {answer.windowsOverlap && answer.change.verdict !== "CANNOT_TELL" &&
          <p class="note">By the boat's clock the data of the two overlap. If they share data, the test does not hold.</p>}
        <Pairs comparison={answer} pairs={pairsOf(answer, find(answer.earlier), find(answer.later))} />
      </>}
    </>
  );
}

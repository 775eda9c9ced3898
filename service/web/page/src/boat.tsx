import type { ComponentChildren } from "preact";
import { useState } from "preact/hooks";
import { order, rollback, save, type Coefficient, type History, type Info, type Job, type KeptDiagnosis, type Model, type PredictedPaths, type Quality, type Report } from "./api";
import { ErrorChart, Intervals } from "./charts";
import { CompareModels } from "./compare";
import { asSentence, clock, diagnosisVerdict, duration, number, percent, significant, unit, words } from "./format";
import { TrackMap, type Track } from "./map";
import { Badge, Bar, Card, Fact, JobLine, Text } from "./parts";
import { PathPlot } from "./paths";
import { useAnswer } from "./use_answer";

function sentence(quality: Quality): string {
  const since = ` since ${clock(quality.verdictSinceUnixS)}`;
  if (quality.verdict === "OK") {
    return `Telemetry arrives and the model matches the boat${since}.`;
  }
  return asSentence(quality.reasons[0]?.text ?? "");
}

function Telemetry({ quality }: { quality: Quality }) {
  const rates = quality.ratesHz;
  const hasSent = quality.accepted > 0 || quality.rejected.length > 0;
  return (
    <Card title="Telemetry">
      <dl>
        <Fact name="Fixes">{significant(rates.gnss)} Hz</Fact>
        <Fact name="Headings">{significant(rates.heading)} Hz</Fact>
        <Fact name="Thruster commands">{significant(rates.thrusters)} Hz</Fact>
        <Fact name="Newest sample">{hasSent ? `${duration(quality.silentS)} ago` : "none"}</Fact>
        <Fact name="Window">{significant(quality.windowS)} s <Bar share={quality.windowFill} label="window filled" /></Fact>
        <Fact name="Lost, last minute">{percent(quality.lossShare)}</Fact>
        <Fact name="Rejected, last minute">{percent(quality.rejectShare)}</Fact>
      </dl>
      {quality.rejected.length > 0 && (
        <details>
          <summary>Rejected since the daemon started</summary>
          <table>
            <thead><tr><th scope="col">channel</th><th scope="col">reason</th><th scope="col" class="number">samples</th></tr></thead>
            <tbody>
              {quality.rejected.map((entry) => (
                <tr key={entry.channel + entry.reason}>
                  <td>{entry.channel}</td><td>{words(entry.reason)}</td><td class="number">{entry.count}</td>
                </tr>
              ))}
            </tbody>
          </table>
        </details>
      )}
    </Card>
  );
}

function withBounds(coefficient: Coefficient): string {
  const interval = coefficient.interval;
  const bounds = interval
    ? ` [${significant(number(interval.lower))}, ${significant(number(interval.upper))}]` : "";
  return `${significant(coefficient.estimate)}${bounds} ${unit(coefficient.unit)}`;
}

const kChannels: { [channel: string]: string } = { gnss: "Fixes", thrusters: "Commands" };

/** What the newest model knows of time: lag of the thrusters and delays of the channels. */
function Delays({ model, delays }: { model?: Model; delays: NonNullable<Quality["model"]>["delays"] }) {
  const lag = model?.thrusterTimeConstantS;
  if (!lag && delays.length === 0) return null;
  return (
    <>
      <h3>Delays</h3>
      <dl>
        {lag && <Fact name="Thruster lag">{withBounds(lag)}</Fact>}
        {delays.map(({ channel, estimateS, lowerS, upperS }) => (
          <Fact key={channel} name={`${kChannels[channel] ?? channel} behind headings`}>
            {significant(estimateS, 2)} [{significant(lowerS, 2)}, {significant(upperS, 2)}] s
          </Fact>
        ))}
      </dl>
    </>
  );
}

/** Coefficients without bounds, and the manoeuvre that would give them some. */
function Identifiability({ model }: { model?: Model }) {
  if (!model || model.refusals.length === 0) return null;
  return (
    <>
      <h3>What the data do not determine</h3>
      <ul>{model.refusals.map(({ subject, reason, advice }) =>
        <li key={subject}><strong>{subject}</strong>: {reason}. <span class="advice">{asSentence(advice)}</span></li>)}</ul>
    </>
  );
}

function ModelFacts({ quality, newest }: { quality: Quality; newest?: Model }) {
  const model = quality.model;
  if (!model) {
    return <Card title="Model"><p class="empty">No model has been published.</p></Card>;
  }
  return (
    <Card title="Model">
      <dl>
        <Fact name="Revision">{model.revision}, {duration(model.ageS)} old</Fact>
        {model.verdict && <Fact name="Verdict when made">
          <Badge verdict={model.verdict} /> {asSentence(model.verdictReason)}</Fact>}
        <Fact name="Free-run error now">{model.predictionError > 0 ? `${significant(model.predictionError)} × normal` : "–"}</Fact>
        <Fact name="Drift">{model.driftSinceUnixS > 0 ? `since ${clock(model.driftSinceUnixS)}` : model.driftUntested ? "none seen" : "none"}</Fact>
        {model.driftUntested && <Fact name="Drift not tested">{asSentence(model.driftUntested)}</Fact>}
        <Fact name="Identified">{model.identified} of {model.coefficients} coefficients</Fact>
        <Fact name="Median half width">{model.relativeHalfWidth > 0 ? percent(model.relativeHalfWidth) : "–"} of the estimate</Fact>
      </dl>
      <Delays model={newest} delays={model.delays} />
      <Identifiability model={newest} />
      {quality.lastRefusal && (
        <p class="note"><strong>Last refusal.</strong> {quality.lastRefusal.subject}: {quality.lastRefusal.reason}. {quality.lastRefusal.advice}</p>
      )}
    </Card>
  );
}

const kEquations = [["SURGE", "Surge"], ["SWAY", "Sway"], ["YAW", "Yaw"]] as const;

function Coefficients({ models }: { models: Model[] }) {
  const [equation, setEquation] = useState("SURGE");
  const press = (event: KeyboardEvent) => {
    const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
    if (!step) return;
    const at = kEquations.findIndex(([key]) => key === equation);
    const next = kEquations[(at + step + kEquations.length) % kEquations.length];
    if (!next) return;
    setEquation(next[0]);
    document.getElementById(`tab-${next[0]}`)?.focus();
  };
  return (
    <Card title="Coefficients and their bounds, revision by revision" wide>
      {models.length === 0 ? <p class="empty">No model has been published.</p> : <>
        <div class="tabs" role="tablist" aria-label="Equation" onKeyDown={press}>
          {kEquations.map(([key, name]) => (
            <button key={key} id={`tab-${key}`} type="button" role="tab" aria-controls="coefficients"
              aria-selected={key === equation} tabIndex={key === equation ? 0 : -1}
              onClick={() => setEquation(key)}>{name}</button>
          ))}
        </div>
        <div id="coefficients" role="tabpanel" aria-labelledby={`tab-${equation}`}>
          <Intervals models={models} equation={equation} />
        </div>
      </>}
    </Card>
  );
}

function Cause({ cause }: { cause: Report["causes"][number] }) {
  const faint = cause.probability < 0.05;
  return (
    <li class={faint ? "cause faint" : "cause"}>
      <div class="cause-head">
        <strong>{cause.effects.map(words).join(" + ")}</strong>
        <Bar share={cause.probability} label={`probability of ${cause.effects.map(words).join(" and ")}`} />
      </div>
      {!faint && cause.parts.map((part) => <p key={part.effect}>{part.sentence}</p>)}
      {!faint && cause.parameters.length > 0 && (
        <p class="muted">{cause.parameters.map((parameter) =>
          `${words(parameter.name)} ${significant(parameter.estimate)} ± ${significant(number(parameter.standardError), 2)} ${unit(parameter.unit)}`.trim()).join("; ")}</p>
      )}
      {cause.indistinguishable.length > 0 && (
        <p class="muted">These data cannot separate it from {cause.indistinguishable.map(words).join(", ")}.</p>
      )}
    </li>
  );
}

const kPlacesAtMost = 5;

/** Where the excess error sits, most of it first. */
function Where({ places }: { places: Report["where"] }) {
  if (places.length === 0) return null;
  return (
    <>
      <h3>Where the excess error sits</h3>
      <ul>{places.slice(0, kPlacesAtMost).map(({ channel, propellerRegion, bin, excessShare, kind }) => (
        <li key={`${channel} ${propellerRegion} ${bin}`}>
          {[words(channel), propellerRegion === "ALL" ? "" : `propellers ${propellerRegion}`, bin].filter(Boolean).join(", ")}:
          {" "}{percent(excessShare)} of it, {kKinds[kind] ?? words(kind)}
        </li>
      ))}</ul>
    </>
  );
}

const kKinds: { [kind: string]: string } = { BIAS: "an offset", SLOPE: "in proportion", TIMING: "timing", NOISE: "noise" };

/** A diagnosis in full. */
function Diagnosis({ route }: { route: string }) {
  const { answer: report, fault } = useAnswer<Report>(route, null);
  if (!report) return <p class="empty">{fault || (report === null ? "It is no longer kept." : "Loading.")}</p>;
  const gap = report.gap;
  const likely = report.causes.filter((cause) => cause.probability >= 0.005);
  return (
    <>
      <p class="lead">{!report.sentence.startsWith(diagnosisVerdict(report.verdict)) &&
        <strong>{diagnosisVerdict(report.verdict)}. </strong>}{report.sentence}</p>
      <p class="muted">Of {clock(report.publishedUnixS)}, against revision {report.modelRevision}.
        {gap && ` Error ${significant(gap.before)} times the normal error before, ${significant(gap.after)} with the causes; floor ${significant(gap.noiseFloor)}.`}
        {gap?.closure !== undefined && ` Excess error explained: ${percent(gap.closure)}.`}</p>
      {likely.length > 0 && <><h3>Causes, by probability</h3>
        <ul class="causes">{likely.map((cause) => <Cause key={cause.effects.join()} cause={cause} />)}</ul></>}
      <Where places={report.where} />
      <h3>What to do next</h3>
      {report.advice.length > 0
        ? <ul>{report.advice.map((advice) => (
            <li key={advice.manoeuvre}>{words(advice.manoeuvre)}, {duration(advice.durationS)}: {advice.how || `separates ${advice.separates.map(words).join(" and ")}`}</li>))}</ul>
        : <p>{report.verdict === "NO_MATERIAL_GAP"
            ? "Nothing: the model matches the boat."
            : report.verdict === "EXPLAINED"
              ? "No manoeuvre would separate the causes better. Inspect the named part, then refresh the model."
              : "Record more varied driving, in both directions and at several speeds, and diagnose again."}</p>}
      <p><a href={`api/v1${route}/report`}>The report with its charts</a></p>
    </>
  );
}

/** The last diagnosis, and those before it to open in its place. `when` changes with each new one. */
function Diagnoses({ vehicleId, when }: { vehicleId: string; when: unknown }) {
  const route = `/vehicles/${encodeURIComponent(vehicleId)}/diagnoses`;
  const { answer: list } = useAnswer<{ diagnoses: KeptDiagnosis[] }>(route, when);
  const [chosen, choose] = useState<number | null>(null);  // null: the last
  const kept = list?.diagnoses ?? [];
  const shown = chosen ?? kept[0]?.publishedUnixS;
  return (
    <Card title={chosen === null ? "Last diagnosis" : "An earlier diagnosis"} wide>
      {shown === undefined
        ? <p class="empty">{list && "This boat has not been diagnosed."}</p>
        : <Diagnosis key={shown} route={`${route}/${shown}`} />}
      {kept.length > 1 && <KeptDiagnoses kept={kept} shown={shown}
        choose={(published) => choose(published === kept[0]?.publishedUnixS ? null : published)} />}
    </Card>
  );
}

function KeptDiagnoses({ kept, shown, choose }: {
  kept: KeptDiagnosis[];
  shown?: number;
  choose: (publishedUnixS: number) => void;
}) {
  return (
    <>
      <h3>All diagnoses, newest first</h3>
      <div class="scroll">
        <table class="kept">
          <thead><tr><th scope="col">published</th><th scope="col" class="number">revision</th><th scope="col">diagnosis</th>
            <th scope="col"><span class="unseen">open</span></th></tr></thead>
          <tbody>
            {kept.map(({ publishedUnixS, modelRevision, verdict, sentence }) => (
              <tr key={publishedUnixS} aria-current={publishedUnixS === shown}>
                <th scope="row">{clock(publishedUnixS)}</th>
                <td class="number">{modelRevision}</td>
                <td class="sentence">{!sentence.startsWith(diagnosisVerdict(verdict)) && <strong>{diagnosisVerdict(verdict)}. </strong>}{sentence}</td>
                <td><button type="button" disabled={publishedUnixS === shown} onClick={() => choose(publishedUnixS)}
                  aria-label={`Open the diagnosis of ${clock(publishedUnixS)}`}>Open</button></td>
              </tr>
            ))}
          </tbody>
        </table>
      </div>
    </>
  );
}

function Models({ vehicleId, models, takesOrders, token }: {
  vehicleId: string;
  models: Model[];
  takesOrders: boolean;
  token: string;
}) {
  const [outcome, setOutcome] = useState("");
  const [fault, setFault] = useState("");
  if (models.length === 0) return null;
  const tell = async (act: () => Promise<string>) => {
    setOutcome("");
    setFault("");
    try {
      setOutcome(await act());
    } catch (error) {
      setFault((error as Error).message);
    }
  };
  const rollBack = (revision: string) => tell(async () =>
    `Revision ${revision} is published again as revision ${await rollback(vehicleId, revision, token)}.`);
  const file = (revision: string) => `/vehicles/${encodeURIComponent(vehicleId)}/models/${revision}`;
  const exportFor = (revision: string, format: string) => tell(async () => {
    await save(`${file(revision)}/export?format=${format}`);
    return `Revision ${revision} is saved for ${format.toUpperCase()}.`;
  });
  return (
    <Card title="Models" wide>
      {outcome && <p role="status">{outcome}</p>}
      {fault && <p class="fault" role="alert">{fault}</p>}
      <div class="scroll">
        <table class="models">
          <thead>
            <tr>
              <th scope="col">revision</th><th scope="col">published</th><th scope="col">structure</th>
              <th scope="col">estimator</th><th scope="col" class="number">identified</th>
              <th scope="col">against the one before</th><th scope="col">file</th><th scope="col">export</th>
              {takesOrders && <th scope="col">earlier model</th>}
            </tr>
          </thead>
          <tbody>
            {models.map((model, place) => {
              const revision = model.provenance.revision;
              const change = model.provenance.change;
              const identified = model.coefficients.filter((coefficient) => coefficient.status === "ESTIMATED").length;
              return (
                <tr key={revision}>
                  <th scope="row">{revision}</th>
                  <td class="published">{clock(model.provenance.publishedUnixS)}</td>
                  <td data-name="structure">{words(model.structure)}</td>
                  <td data-name="estimator">{words(model.estimator)}</td>
                  <td class="number" data-name="identified">{identified} of {model.coefficients.length}</td>
                  <td data-name="against the one before">{change ? `${words(change.verdict)}${Number.isFinite(change.pValue) && change.verdict !== "CANNOT_TELL" ? `, p ${significant(change.pValue, 2)}` : ""}` : "–"}</td>
                  <td><a href={`api/v1${file(revision)}`}
                    download={`${vehicleId}-r${revision}.json`} aria-label={`Download revision ${revision}`}>model.json</a></td>
                  <td class="exports">{["mss", "vrx"].map((format) => (
                    <button key={format} type="button" onClick={() => exportFor(revision, format)}
                      aria-label={`Export revision ${revision} for ${format.toUpperCase()}`}>{format.toUpperCase()}</button>
                  ))}</td>
                  {takesOrders && <td>{place > 0 &&
                    <button type="button" disabled={token === ""} onClick={() => rollBack(revision)}
                      aria-label={`Roll back to revision ${revision}`}>Roll back</button>}</td>}
                </tr>
              );
            })}
          </tbody>
        </table>
      </div>
      {models.length > 1 && <CompareModels vehicleId={vehicleId} models={models} />}
    </Card>
  );
}

/** Orders, where the daemon takes them. */
function Orders({ vehicleId, info, jobs, token, setToken }: {
  vehicleId: string;
  info: Info | null;
  jobs: Job[];
  token: string;
  setToken: (token: string) => void;
}) {
  const [fault, setFault] = useState("");
  const send = async (kind: "refresh" | "diagnose") => {
    setFault("");
    try {
      await order(kind, vehicleId, token);
      sessionStorage.setItem("token", token);
    } catch (error) {
      setFault((error as Error).message);
    }
  };
  let controls: ComponentChildren = null;
  if (info?.readOnly) {
    controls = <p class="muted">Read-only: this daemon takes no orders over HTTP (<code>http.token_file</code>).</p>;
  } else if (info) {
    controls = (
      <form class="orders" onSubmit={(event) => event.preventDefault()}>
        <label>Token <input type="password" autocomplete="off" value={token}
          onInput={(event) => setToken(event.currentTarget.value)} /></label>
        <button type="button" disabled={token === ""} onClick={() => send("refresh")}>Refresh the model</button>
        <button type="button" disabled={token === ""} onClick={() => send("diagnose")}>Diagnose</button>
      </form>
    );
  }
  return (
    <>
      {controls}
      {fault && <p class="fault" role="alert">{fault}</p>}
      {jobs.slice(0, 2).map((job) => <JobLine key={job.id} job={job} />)}
    </>
  );
}

export function BoatView({ vehicleId, round, info, jobs, track }: {
  vehicleId: string;
  round: number;  // counts up with each report of the daemon
  info: Info | null;
  jobs: Job[];
  track?: Track;
}) {
  const route = `/vehicles/${encodeURIComponent(vehicleId)}`;
  const { answer: quality, fault } = useAnswer<Quality>(route, round);
  const { answer: history } = useAnswer<History>(`${route}/history`, Math.floor(round / 4));
  const finished = jobs.filter((job) => job.state !== "RUNNING").length;
  const revision = quality?.model?.revision;
  const { answer: list } = useAnswer<{ models: Model[] }>(`${route}/models?limit=20`, revision);
  const { answer: paths } = useAnswer<PredictedPaths>(`${route}/predicted-paths`, `${Math.floor(round / 5)} ${revision}`);
  const models = list?.models ?? [];
  const [token, setToken] = useState(sessionStorage.getItem("token") ?? "");  // it stays in this tab

  const head = <nav aria-label="Back"><a href="#/">← Fleet</a></nav>;
  if (quality === null) return <main>{head}<p class="empty">This daemon serves no boat named {vehicleId}.</p></main>;
  if (!quality) return <main>{head}<p class="empty">{fault || "Loading."}</p></main>;
  return (
    <main>
      {head}
      <header class="boat-head">
        <h1>{vehicleId}</h1>
        <Badge verdict={quality.verdict} />
      </header>
      <p class="lead"><Text>{sentence(quality)}</Text></p>
      {quality.verdict !== "OK" && <p class="muted">{quality.verdict} since {clock(quality.verdictSinceUnixS)}.</p>}
      {quality.reasons.length > 1 && (
        <ul class="reasons">{quality.reasons.slice(1).map((reason) =>
          <li key={reason.code}><Badge verdict={reason.verdict} /> <Text>{reason.text}</Text></li>)}</ul>
      )}
      {quality.proposal && <p class="note"><Text>{quality.proposal}</Text></p>}
      <Orders vehicleId={vehicleId} info={info} jobs={jobs} token={token} setToken={setToken} />
      <div class="cards">
        <Card title="Free-run error over the last hour" wide>
          {history && <ErrorChart history={history} />}
        </Card>
        <ModelFacts quality={quality} newest={models[0]} />
        <Telemetry quality={quality} />
        <Card title="Track of the last ten minutes">
          <TrackMap tracks={track ? [track] : []} selected={vehicleId} label={`Track of ${vehicleId}, north up`} />
        </Card>
        <Card title="Newest three minutes, predicted and measured">
          {paths && <PathPlot paths={paths} />}
          {paths === null && <p class="empty">No prediction yet: it needs a model and a minute of telemetry without a gap.</p>}
        </Card>
        <Coefficients models={models} />
        <Diagnoses vehicleId={vehicleId} when={`${finished} ${quality.diagnosis?.publishedUnixS}`} />
        <Models vehicleId={vehicleId} models={models} takesOrders={info !== null && !info.readOnly} token={token} />
      </div>
    </main>
  );
}

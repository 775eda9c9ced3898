// What the daemon answers, by idl/proto/{fleet,quality,model,report}.proto, and how it is asked.

export type Verdict = "OK" | "WARN" | "ERROR" | "STALE" | "UNKNOWN";

export interface Position {
  latitudeDeg: number;
  longitudeDeg: number;
  headingDeg?: number;
}

export interface Summary {
  vehicleId: string;
  verdict: Verdict;
  verdictSinceUnixS: number;
  reason: string;
  windowFill: number;
  lossShare: number;
  rejectShare: number;
  modelRevision: number;
  modelAgeS: number;
  predictionError: number;
  drifts: boolean;
  position?: Position;
}

export interface VehicleList {
  timeUnixS: number;
  total: number;
  next: string;
  vehicles: Summary[];
}

export interface Quality {
  vehicleId: string;
  verdict: Verdict;
  verdictSinceUnixS: number;
  reasons: { code: string; verdict: Verdict; text: string }[];
  silentS: number;
  windowS: number;
  windowFill: number;
  ratesHz: { gnss: number; heading: number; thrusters: number };
  accepted: number;
  lost: number;
  lossShare: number;
  rejectShare: number;
  rejected: { channel: string; reason: string; count: number }[];
  model?: {
    revision: number;
    ageS: number;
    predictionError: number;
    driftSinceUnixS: number;
    driftUntested: string;  // of which changes the monitor cannot tell now, and why
    coefficients: number;
    identified: number;
    relativeHalfWidth: number;
    verdict: "" | Verdict;  // given when it was made
    verdictReason: string;
    delays: { channel: string; estimateS: number; lowerS: number; upperS: number }[];
  };
  proposal: string;
  diagnosis?: { publishedUnixS: number };
  lastRefusal?: { subject: string; reason: string; advice: string };
}

export interface Coefficient {
  equation: "SURGE" | "SWAY" | "YAW" | "UNKNOWN_EQUATION";
  regressor: string;
  symbol: string;
  estimate: number;
  standardError: number | string;
  interval?: { level: number; lower: number | string; upper: number | string };
  unit: string;
  status: string;
}

export interface Model {
  structure: string;
  estimator: string;
  coefficients: Coefficient[];
  thrusterTimeConstantS?: Coefficient;
  parameters?: Coefficient[];  // of the physical form
  window?: { startS: number; endS: number; samples: number };
  refusals: { subject: string; reason: string; advice: string }[];
  provenance: {
    revision: string;
    publishedUnixS: number;
    softwareVersion: string;
    change?: { verdict: string; revision: string; pValue: number };
  };
}

export interface Comparison {
  earlier: number;
  later: number;
  sentence: string;
  windowsOverlap: boolean;
  change: {
    verdict: string;
    coefficients: {
      equation: Coefficient["equation"];
      regressor: string;
      symbol: string;
      difference: number;
      standardError: number;
      pValue: number;
    }[];
  };
}

export interface Path {
  timeS: number[];
  northM: number[];
  eastM: number[];
}

export interface PredictedPaths {
  revision: number;
  horizonS: number;
  measured: Path;
  predicted: Path[];
  positionRmseM: number | string;
}

export interface Report {
  verdict: string;
  sentence: string;
  publishedUnixS: number;
  modelRevision: string;
  gap?: { before: number; after: number; noiseFloor: number; closure?: number };
  where: { channel: string; propellerRegion: string; bin: string; excessShare: number; kind: string }[];
  causes: {
    effects: string[];
    probability: number;
    parameters: { name: string; estimate: number; standardError: number | string; unit: string }[];
    indistinguishable: string[];
    parts: { effect: string; sentence: string }[];
  }[];
  advice: { manoeuvre: string; separates: string[]; durationS: number; how: string }[];
}

export interface KeptDiagnosis {
  publishedUnixS: number;  // tells it from the others of its boat
  modelRevision: number;
  verdict: string;
  sentence: string;
}

export interface History {
  timeUnixS: number[];
  predictionError: number[];
  latitudeDeg: (number | string)[];
  longitudeDeg: (number | string)[];
}

export interface Job {
  id: string;
  vehicleId: string;
  kind: "REFRESH" | "DIAGNOSE" | "UNKNOWN_KIND";
  state: "RUNNING" | "PUBLISHED" | "REFUSED" | "FAILED" | "UNKNOWN_STATE";
  stage: string;
  fraction: number;
  message: string;
  refusals: { subject: string; reason: string; advice: string }[];
  revision: number;
}

export interface Info {
  version: string;
  vehicles: number;
  readOnly: boolean;
}

/** The answer of the daemon, or null where it has none (404). */
export async function get<T>(route: string): Promise<T | null> {
  const response = await fetch(`api/v1${route}`);
  if (response.status === 404) return null;
  if (!response.ok) throw new Error(`the daemon answers ${response.status}`);
  return (await response.json()) as T;
}

export async function allVehicles(): Promise<Summary[]> {
  const vehicles: Summary[] = [];
  let after = "";
  do {
    const page = await get<VehicleList>(`/vehicles?limit=1000&after=${encodeURIComponent(after)}`);
    if (!page) break;
    vehicles.push(...page.vehicles);
    after = page.next;
  } while (after !== "");
  return vehicles;
}

async function post<T>(route: string, body: object, token: string): Promise<T> {
  const response = await fetch(`api/v1${route}`, {
    method: "POST",
    headers: { "Content-Type": "application/json", Authorization: `Bearer ${token}` },
    body: JSON.stringify(body),
  });
  const answer = await response.json();
  if (!response.ok) throw new Error(answer.error ?? `the daemon answers ${response.status}`);
  return answer as T;
}

/** Saves what the daemon answers as a file of its name; throws its reason where it has none. */
export async function save(route: string) {
  const response = await fetch(`api/v1${route}`);
  if (!response.ok) {
    const { error, allowed } = await response.json();
    throw new Error(`${error}. ${allowed}`);
  }
  const link = document.createElement("a");
  link.href = URL.createObjectURL(await response.blob());
  link.download = /filename="(.+)"/.exec(response.headers.get("Content-Disposition") ?? "")?.[1] ?? "";
  link.click();
  URL.revokeObjectURL(link.href);
}

/** Asks for a new model or a diagnosis. */
export function order(kind: "refresh" | "diagnose", vehicleId: string, token: string) {
  return post<Job>(`/${kind}`, { vehicleId }, token);
}

/** Publishes an earlier revision again, and gives back the new one. */
export async function rollback(vehicleId: string, revision: string, token: string) {
  const model = await post<Model>("/rollback", { vehicleId, revision: Number(revision) }, token);
  return model.provenance.revision;
}

/** Follows the daemon for as long as the page is open, across its restarts. */
export function follow(on: {
  fleet: (list: VehicleList) => void;
  job: (job: Job) => void;
  connected: (is: boolean) => void;
}) {
  const source = new EventSource("api/v1/events");
  source.addEventListener("fleet", (event) => on.fleet(JSON.parse((event as MessageEvent).data)));
  source.addEventListener("job", (event) => on.job(JSON.parse((event as MessageEvent).data)));
  source.onopen = () => on.connected(true);
  source.onerror = () => {
    on.connected(false);
    if (source.readyState !== EventSource.CLOSED) return;  // the browser tries again
    setTimeout(() => follow(on), 3000);
  };
}

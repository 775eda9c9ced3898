import { render } from "preact";
import { useEffect, useRef, useState } from "preact/hooks";
import { allVehicles, follow, get, type History, type Info, type Job, type Summary } from "./api";
import { BoatView } from "./boat";
import { FleetView } from "./fleet";
import { number } from "./format";
import type { Track } from "./map";
import "./page.css";

const kRetryMs = 3000;
const kTrackPoints = 600;
const kPointsOfAll = 60_000;  // so that a large fleet is drawn within a frame

/** "#/boat/ID" -> ID; empty: the fleet. */
function boatOf(hash: string): string {
  const match = /^#\/boat\/(.+)$/.exec(hash);
  return match?.[1] ? decodeURIComponent(match[1]) : "";
}

function useBoat(): string {
  const [boat, setBoat] = useState(boatOf(location.hash));
  useEffect(() => {
    const change = () => {
      setBoat(boatOf(location.hash));
      scrollTo(0, 0);
    };
    addEventListener("hashchange", change);
    return () => removeEventListener("hashchange", change);
  }, []);
  return boat;
}

type Paths = Map<string, { latitudeDeg: number[]; longitudeDeg: number[] }>;

async function loadPaths(): Promise<Paths> {
  const list = await get<{ tracks: { vehicleId: string; history?: History }[] }>("/tracks?seconds=600");
  const paths: Paths = new Map();
  for (const { vehicleId, history } of list?.tracks ?? []) {
    const path = { latitudeDeg: [] as number[], longitudeDeg: [] as number[] };
    history?.latitudeDeg.forEach((value, index) => {
      const latitude = number(value);
      if (!Number.isFinite(latitude)) return;
      path.latitudeDeg.push(latitude);
      path.longitudeDeg.push(number(history.longitudeDeg[index]));
    });
    paths.set(vehicleId, path);
  }
  return paths;
}

/** Adds where the boats are now. Of a large fleet only every so many rounds leave a point. */
function extend(paths: Paths, vehicles: Summary[], round: number) {
  const most = Math.max(2, Math.min(kTrackPoints, Math.floor(kPointsOfAll / vehicles.length)));
  const leavesPoint = round % Math.ceil(kTrackPoints / most) === 0;
  for (const { vehicleId, position } of vehicles) {
    if (!position) continue;
    const path = paths.get(vehicleId) ?? { latitudeDeg: [], longitudeDeg: [] };
    paths.set(vehicleId, path);
    if (path.latitudeDeg.at(-1) === position.latitudeDeg && path.longitudeDeg.at(-1) === position.longitudeDeg) continue;
    if (!leavesPoint && path.latitudeDeg.length > 1) {
      path.latitudeDeg.pop();
      path.longitudeDeg.pop();
    }
    path.latitudeDeg.push(position.latitudeDeg);
    path.longitudeDeg.push(position.longitudeDeg);
    if (path.latitudeDeg.length > most) {
      path.latitudeDeg.shift();
      path.longitudeDeg.shift();
    }
  }
}

interface State {
  vehicles: Summary[];
  timeUnixS: number;
  round: number;
}

function Page() {
  const boat = useBoat();
  const [{ vehicles, timeUnixS, round }, setState] = useState<State>({ vehicles: [], timeUnixS: Date.now() / 1000, round: 0 });
  const [connected, setConnected] = useState<boolean | null>(null);
  const [info, setInfo] = useState<Info | null>(null);
  const [jobs, setJobs] = useState<Job[]>([]);
  const paths = useRef<Paths>(new Map());
  const rounds = useRef(0);

  useEffect(() => {
    let live = false;
    // The boats first: their tracks are the larger answer.
    const load = async () => {
      const all = await allVehicles();
      setState((state) => ({ ...state, vehicles: all, round: state.round + 1 }));
      const [served, known, past] = await Promise.all([get<Info>(""), get<{ jobs: Job[] }>("/jobs?limit=100"), loadPaths()]);
      paths.current = past;
      setInfo(served);
      setJobs(known?.jobs ?? []);
      setState((state) => ({ ...state, round: state.round + 1 }));
    };
    const loadUntilAnswered = () => {
      if (live) load().catch(() => setTimeout(loadUntilAnswered, kRetryMs));
    };
    follow({
      fleet: (list) => {
        extend(paths.current, list.vehicles, rounds.current++);
        setState((state) => ({ vehicles: list.vehicles, timeUnixS: list.timeUnixS, round: state.round + 1 }));
      },
      job: (job) => setJobs((before) => [job, ...before.filter((other) => other.id !== job.id)].slice(0, 200)),
      connected: (is) => {
        live = is;
        setConnected(is);
        loadUntilAnswered();
      },
    });
  }, []);
  useEffect(() => {
    const worst = vehicles.filter(({ verdict }) => verdict !== "OK").length;
    document.title = boat ? `${boat} · Telltale` : worst > 0 ? `(${worst}) Telltale` : "Telltale";
  });

  const tracks: Track[] = vehicles.map(({ vehicleId, verdict, position }) => ({
    id: vehicleId,
    verdict,
    latitudeDeg: paths.current.get(vehicleId)?.latitudeDeg ?? [],
    longitudeDeg: paths.current.get(vehicleId)?.longitudeDeg ?? [],
    headingDeg: position?.headingDeg,
  }));
  return (
    <>
      <header class="top">
        <a class="name" href="#/"><img src="icon.svg" alt="" width="24" height="24" /> Telltale</a>
        <span class={connected === false ? "live lost" : "live"} role="status">
          {connected === null ? "Connecting" : connected ? "Live" : "No connection; trying again"}
        </span>
      </header>
      {boat
        ? <BoatView key={boat} vehicleId={boat} round={round} info={info}
            jobs={jobs.filter((job) => job.vehicleId === boat)}
            track={tracks.find((track) => track.id === boat)} />
        : <FleetView vehicles={vehicles} tracks={tracks} now={timeUnixS} heard={round > 0} />}
      <footer class="muted">{info && `Telltale ${info.version}`} · <a href="metrics">metrics</a> · <a href="api/v1/openapi.json">API</a></footer>
    </>
  );
}

const root = document.getElementById("page");
if (root) render(<Page />, root);

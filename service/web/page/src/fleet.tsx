import { useEffect, useMemo, useRef, useState } from "preact/hooks";
import type { Summary, Verdict } from "./api";
import { duration, percent, significant, urgency } from "./format";
import { TrackMap, type Track } from "./map";
import { Badge, Text } from "./parts";

type Column = "vehicleId" | "verdict" | "predictionError" | "windowFill" | "lossShare" | "rejectShare" | "modelAgeS";

const kColumns: { key: Column; name: string; title?: string; numeric?: boolean }[] = [
  { key: "vehicleId", name: "Boat" },
  { key: "verdict", name: "Verdict" },
  { key: "predictionError", name: "Error", title: "Free-run error over 5 s, in units of the normal error", numeric: true },
  { key: "windowFill", name: "Window", title: "Share of the window that telemetry fills", numeric: true },
  { key: "lossShare", name: "Lost", title: "Samples of the last minute", numeric: true },
  { key: "rejectShare", name: "Rejected", title: "Samples of the last minute", numeric: true },
  { key: "modelAgeS", name: "Model", title: "Revision and age", numeric: true },
];
const kVerdicts: Verdict[] = ["ERROR", "STALE", "WARN", "OK"];
const kRowsAtOnce = 100;

export interface Order {
  column: Column;
  descends: boolean;
}

// Made once: localeCompare makes one for each pair of a thousand boats.
const byName = new Intl.Collator(undefined, { numeric: true }).compare;

/** Worst first: by urgency, then by the longest in that state, then by name. */
function compare(a: Summary, b: Summary, { column, descends }: Order): number {
  const sign = descends ? -1 : 1;
  if (column === "vehicleId") return sign * byName(a.vehicleId, b.vehicleId);
  const difference = column === "verdict"
    ? urgency(a.verdict) - urgency(b.verdict)
    : a[column] - b[column];
  return sign * difference || byName(a.vehicleId, b.vehicleId);
}

function Row({ vehicle, now, pointAt }: { vehicle: Summary; now: number; pointAt: (id?: string) => void }) {
  const modelled = vehicle.modelRevision > 0;
  return (
    <tr class={vehicle.verdict.toLowerCase()}>
      <th scope="row">
        <a href={`#/boat/${encodeURIComponent(vehicle.vehicleId)}`} onFocus={() => pointAt(vehicle.vehicleId)}
          onBlur={() => pointAt()}>{vehicle.vehicleId}</a>
      </th>
      <td class="verdict">
        <Badge verdict={vehicle.verdict} />
        <span class="muted since">for {duration(now - vehicle.verdictSinceUnixS)}</span>
        {vehicle.reason && <span class="reason"><Text>{vehicle.reason}</Text></span>}
      </td>
      <td class="number" data-name="error">{vehicle.predictionError > 0 ? `${significant(vehicle.predictionError)} ×` : "–"}</td>
      <td class="number" data-name="window">{percent(vehicle.windowFill)}</td>
      <td class="number" data-name="lost">{percent(vehicle.lossShare)}</td>
      <td class="number" data-name="rejected">{percent(vehicle.rejectShare)}</td>
      <td class="number" data-name="model">{modelled ? `r${vehicle.modelRevision}, ${duration(vehicle.modelAgeS)}` : "none"}</td>
    </tr>
  );
}

/** Up and down go from boat to boat, Enter opens. "/" goes to the search. */
function useKeys(table: { current: HTMLTableElement | null }, search: { current: HTMLInputElement | null }) {
  useEffect(() => {
    const press = (event: KeyboardEvent) => {
      const typing = event.target instanceof HTMLInputElement;
      if (event.key === "/" && !typing) {
        event.preventDefault();
        search.current?.focus();
        return;
      }
      if (event.key !== "ArrowDown" && event.key !== "ArrowUp") return;
      const links = [...(table.current?.querySelectorAll<HTMLAnchorElement>("tbody a") ?? [])];
      const at = links.indexOf(document.activeElement as HTMLAnchorElement);
      if (at < 0 && typing && event.key === "ArrowUp") return;
      const next = links[at < 0 ? 0 : at + (event.key === "ArrowDown" ? 1 : -1)];
      if (!next) return;
      event.preventDefault();
      next.focus();
    };
    document.addEventListener("keydown", press);
    return () => document.removeEventListener("keydown", press);
  }, []);
}

const kServesNone = "This daemon serves no boat: its configuration names none, or other daemons hold them.";

export function FleetView({ vehicles, tracks, now, heard }: {
  vehicles: Summary[];
  tracks: Track[];
  now: number;
  heard: boolean;  // whether the daemon has reported yet
}) {
  const [text, setText] = useState("");
  const [shown, setShown] = useState<Set<Verdict>>(new Set());
  const [order, setOrder] = useState<Order>({ column: "verdict", descends: false });
  const [rows, setRows] = useState(kRowsAtOnce);
  const [pointedAt, pointAt] = useState<string>();  // the boat of the row that has the focus
  const table = useRef<HTMLTableElement>(null);
  const search = useRef<HTMLInputElement>(null);
  useKeys(table, search);

  const matching = useMemo(() => vehicles
    .filter((vehicle) => shown.size === 0 || shown.has(vehicle.verdict))
    .filter((vehicle) => vehicle.vehicleId.toLowerCase().includes(text.toLowerCase()))
    .sort((a, b) => compare(a, b, order)), [vehicles, shown, text, order]);
  const toggle = (verdict: Verdict) => {
    const next = new Set(shown);
    if (!next.delete(verdict)) next.add(verdict);
    setShown(next);
  };
  const sortBy = (column: Column) =>
    setOrder(order.column === column
      ? { column, descends: !order.descends }
      : { column, descends: column !== "vehicleId" && column !== "verdict" });
  const onMap = useMemo(() => {
    const ids = new Set(matching.map((vehicle) => vehicle.vehicleId));
    return tracks.filter((track) => ids.has(track.id));
  }, [matching, tracks]);

  return (
    <main>
      <div class="toolbar">
        <div class="counts" role="group" aria-label="Show boats by verdict">
          {kVerdicts.map((verdict) => (
            <button key={verdict} type="button" class={`count ${verdict.toLowerCase()}`}
              aria-pressed={shown.has(verdict)} onClick={() => toggle(verdict)}>
              <strong>{vehicles.filter((vehicle) => vehicle.verdict === verdict).length}</strong> {verdict}
            </button>
          ))}
        </div>
        <input ref={search} type="search" placeholder="Search boats  ( / )" aria-label="Search boats"
          value={text} onInput={(event) => setText(event.currentTarget.value)} />
      </div>
      <div class="fleet">
        <section aria-label="Boats" class="card list">
          <table ref={table} class="boats">
            <thead>
              <tr>
                {kColumns.map(({ key, name, title, numeric }) => (
                  <th key={key} scope="col" class={numeric ? "number" : ""} title={title}
                    aria-sort={order.column !== key ? "none" : order.descends ? "descending" : "ascending"}>
                    <button type="button" onClick={() => sortBy(key)}>
                      {name}<span aria-hidden="true" class="arrow">{order.column !== key ? "" : order.descends ? "▼" : "▲"}</span>
                    </button>
                  </th>
                ))}
              </tr>
            </thead>
            <tbody>
              {matching.slice(0, rows).map((vehicle) => <Row key={vehicle.vehicleId} vehicle={vehicle} now={now} pointAt={pointAt} />)}
            </tbody>
          </table>
          {matching.length === 0 && <p class="empty">{vehicles.length > 0 ? "No boat matches." : heard ? kServesNone : "Waiting for the first report."}</p>}
          {matching.length > rows &&
            <button type="button" class="more" onClick={() => setRows(rows + kRowsAtOnce)}>
              Show {Math.min(kRowsAtOnce, matching.length - rows)} more of {matching.length}
            </button>}
        </section>
        <section aria-label="Map" class="card map-card">
          <TrackMap tracks={onMap} pointedAt={pointedAt}
            label={`Tracks of ${onMap.length} boats over the last ten minutes, north up`}
            select={(id) => { location.hash = `#/boat/${encodeURIComponent(id)}`; }} />
        </section>
      </div>
    </main>
  );
}

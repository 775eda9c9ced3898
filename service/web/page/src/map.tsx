import { useEffect, useMemo, useRef, useState } from "preact/hooks";
import type { Verdict } from "./api";
import { MapNames, placeNames, type Box, type Place } from "./map_names";

export interface Track {
  id: string;
  verdict: Verdict;
  latitudeDeg: number[];
  longitudeDeg: number[];
  headingDeg?: number;
}

const kLeastUrgentFirst: Verdict[] = ["UNKNOWN", "OK", "WARN", "STALE", "ERROR"];
const kMetresPerDegree = 111_320;
const kMarginPx = 36;
const kReachPx = 24;  // of the pointer, to the nearest boat
const kScalePx = { width: 140, height: 36 };
const kNorthPx = { width: 34, height: 48 };
const kLeastStepPx = 1.5;  // a shorter one is not seen, and a large fleet has many
const kPositionsAtOnce = 2000;  // of tracks, for one frame
const kOutline = [[0, -10], [6, 7], [0, 4], [-6, 7]] as const;  // of a boat, its bow up

interface Projection {
  x: (longitudeDeg: number) => number;
  y: (latitudeDeg: number) => number;
  pixelsPerMetre: number;
}

/** From the least to the greatest of all; the other way round where there is none. */
function rangeOf(tracks: Track[], valuesOf: (track: Track) => number[]): [number, number] {
  let [low, high] = [Infinity, -Infinity];
  for (const track of tracks) {
    for (const value of valuesOf(track)) {
      if (value < low) low = value;
      if (value > high) high = value;
    }
  }
  return [low, high];
}

/** Local tangent plane about the middle of what is shown, north up. */
function projection(tracks: Track[], width: number, height: number): Projection | null {
  const [south, north] = rangeOf(tracks, (track) => track.latitudeDeg);
  const [west, east] = rangeOf(tracks, (track) => track.longitudeDeg);
  if (south > north) return null;
  const eastScale = kMetresPerDegree * Math.cos((((south + north) / 2) * Math.PI) / 180);
  const least = 20;  // metres across, so that a boat at rest does not fill the map with noise
  const spanX = Math.max(least, (east - west) * eastScale);
  const spanY = Math.max(least, (north - south) * kMetresPerDegree);
  const pixelsPerMetre = Math.min((width - 2 * kMarginPx) / spanX, (height - 2 * kMarginPx) / spanY);
  const [midX, midY] = [(west + east) / 2, (south + north) / 2];
  return {
    x: (longitude) => width / 2 + (longitude - midX) * eastScale * pixelsPerMetre,
    y: (latitude) => height / 2 - (latitude - midY) * kMetresPerDegree * pixelsPerMetre,
    pixelsPerMetre,
  };
}

/** 1, 2 or 5 times a power of ten, not above `metres`. */
export function roundLength(metres: number): number {
  const power = 10 ** Math.floor(Math.log10(metres));
  return power * (metres >= 5 * power ? 5 : metres >= 2 * power ? 2 : 1);
}

function drawScale(context: CanvasRenderingContext2D, to: Projection, height: number, ink: string) {
  const metres = roundLength(110 / to.pixelsPerMetre);
  const length = metres * to.pixelsPerMetre;
  context.strokeStyle = context.fillStyle = ink;
  context.lineWidth = 1.5;
  context.beginPath();
  context.moveTo(12, height - 18);
  context.lineTo(12, height - 12);
  context.lineTo(12 + length, height - 12);
  context.lineTo(12 + length, height - 18);
  context.stroke();
  context.fillText(metres >= 1000 ? `${metres / 1000} km` : `${metres} m`, 18, height - 18);
}

function drawNorth(context: CanvasRenderingContext2D, width: number, height: number, ink: string) {
  const [x, y] = [width - 20, height - 42];
  context.fillStyle = ink;
  context.beginPath();
  context.moveTo(x, y);
  context.lineTo(x + 5, y + 14);
  context.lineTo(x, y + 10);
  context.lineTo(x - 5, y + 14);
  context.fill();
  context.fillText("N", x - 4, y + 29);
}

function addTrack(path: Path2D, track: Track, to: Projection) {
  const last = track.latitudeDeg.length - 1;
  let [fromX, fromY] = [NaN, NaN];
  for (let i = 0; i <= last; i++) {
    const x = to.x(track.longitudeDeg[i] ?? 0);
    const y = to.y(track.latitudeDeg[i] ?? 0);
    if (i === 0) path.moveTo(x, y);
    else if (i === last || Math.abs(x - fromX) + Math.abs(y - fromY) >= kLeastStepPx) path.lineTo(x, y);
    else continue;
    [fromX, fromY] = [x, y];
  }
}

function addBoat(path: Path2D, { x, y, headingDeg }: Place) {
  if (headingDeg === undefined) {
    path.moveTo(x + 5, y);
    path.arc(x, y, 5, 0, 2 * Math.PI);
    return;
  }
  const sine = Math.sin((headingDeg * Math.PI) / 180);
  const cosine = Math.cos((headingDeg * Math.PI) / 180);
  kOutline.forEach(([right, down], i) => {
    const [px, py] = [x + right * cosine - down * sine, y + right * sine + down * cosine];
    if (i === 0) path.moveTo(px, py);
    else path.lineTo(px, py);
  });
  path.closePath();
}

/** Where the boats are on the canvas. */
function placesOf(tracks: Track[], to: Projection): Place[] {
  return tracks.flatMap(({ id, verdict, latitudeDeg, longitudeDeg, headingDeg }) => {
    const latitude = latitudeDeg.at(-1);
    const longitude = longitudeDeg.at(-1);
    return latitude === undefined || longitude === undefined ? []
      : [{ id, verdict, x: to.x(longitude), y: to.y(latitude), headingDeg }];
  });
}

/** Where the scale and the arrow to north stand. */
function cornersOf({ width, height }: Box): Box[] {
  return [
    { left: 0, top: height - kScalePx.height, ...kScalePx },
    { left: width - kNorthPx.width, top: height - kNorthPx.height, ...kNorthPx },
  ];
}

/** The boat nearest to the pointer, within its reach. */
function boatAt(places: Place[], event: MouseEvent): string | undefined {
  let [nearest, least]: [string | undefined, number] = [undefined, kReachPx];
  for (const { id, x, y } of places) {
    const distance = Math.hypot(event.offsetX - x, event.offsetY - y);
    if (distance < least) [nearest, least] = [id, distance];
  }
  return nearest;
}

/** Boats of one look. */
interface Group {
  tracks: Track[];
  verdict: Verdict;
  lineWidth: number;
}

/** The selected boat last and thicker; before it the others, the most urgent on top. */
function groupsOf(tracks: Track[], selected?: string): Group[] {
  const groups: Group[] = kLeastUrgentFirst.map((verdict) => ({
    tracks: tracks.filter((track) => track.verdict === verdict && track.id !== selected), verdict, lineWidth: 1.75,
  }));
  for (const track of tracks) if (track.id === selected) groups.push({ tracks: [track], verdict: track.verdict, lineWidth: 3 });
  return groups.filter((group) => group.tracks.length > 0);
}

/** The same boats in groups small enough for one frame each. */
function partsOf(groups: Group[]): Group[] {
  return groups.flatMap((group) => {
    const parts: Group[] = [];
    let positions = Infinity;
    for (const track of group.tracks) {
      if (positions + track.latitudeDeg.length > kPositionsAtOnce) {
        parts.push({ ...group, tracks: [] });
        positions = 0;
      }
      parts.at(-1)?.tracks.push(track);
      positions += track.latitudeDeg.length;
    }
    return parts;
  });
}

/** All tracks of a group at once: a canvas draws one long path in a fraction of the time of a thousand short ones. */
function drawTracks(context: CanvasRenderingContext2D, { tracks, lineWidth }: Group, to: Projection, ink: string) {
  const paths = new Path2D();
  for (const track of tracks) addTrack(paths, track, to);
  context.strokeStyle = ink;
  context.globalAlpha = 0.75;
  context.lineWidth = lineWidth;
  context.lineJoin = "round";
  context.stroke(paths);
  context.globalAlpha = 1;
}

function drawBoats(context: CanvasRenderingContext2D, { tracks }: Group, to: Projection, ink: string, surface: string) {
  const boats = new Path2D();
  for (const place of placesOf(tracks, to)) addBoat(boats, place);
  // The rims below: above, those of a crowd would cover the crowd.
  context.strokeStyle = surface;
  context.lineWidth = 2;
  context.stroke(boats);
  context.fillStyle = ink;
  context.fill(boats);
}

/** A drawing of the map, a step a frame; what stands before is seen until it is done. */
class Drawing {
  private readonly layer = document.createElement("canvas");
  private readonly groups: Group[];
  private frame = 0;

  constructor(private readonly canvas: HTMLCanvasElement, private readonly tracks: Track[], selected: string | undefined,
    private readonly done: (places: Place[]) => void) {
    this.groups = groupsOf(tracks, selected);
  }

  start() {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    const ratio = window.devicePixelRatio || 1;
    this.layer.width = width * ratio;
    this.layer.height = height * ratio;
    const context = this.layer.getContext("2d");
    const to = projection(this.tracks, width, height);
    if (!context || !to) {
      this.show([]);
    } else {
      context.scale(ratio, ratio);
      this.frameByFrame(this.steps(context, to));
    }
  }

  stop() {
    cancelAnimationFrame(this.frame);
  }

  private colour(name: string) {
    return getComputedStyle(this.canvas).getPropertyValue(name).trim();
  }

  private colourOf(verdict: Verdict) {
    return this.colour(`--${verdict.toLowerCase()}`);
  }

  /** Tracks, over them the boats, and last what says where. */
  private steps(context: CanvasRenderingContext2D, to: Projection): (() => void)[] {
    return [
      ...partsOf(this.groups).map((part) => () => drawTracks(context, part, to, this.colourOf(part.verdict))),
      ...this.groups.map((group) => () => drawBoats(context, group, to, this.colourOf(group.verdict), this.colour("--surface"))),
      () => this.finish(context, to),
    ];
  }

  private frameByFrame([step, ...rest]: (() => void)[]) {
    step?.();
    if (rest.length > 0) this.frame = requestAnimationFrame(() => this.frameByFrame(rest));
  }

  private finish(context: CanvasRenderingContext2D, to: Projection) {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    const muted = this.colour("--muted");
    context.font = "12px system-ui, sans-serif";
    drawScale(context, to, height, muted);
    drawNorth(context, width, height, muted);
    this.show(placesOf(this.tracks, to));
  }

  private show(places: Place[]) {
    this.canvas.width = this.layer.width;
    this.canvas.height = this.layer.height;
    if (this.layer.width > 0 && this.layer.height > 0) this.canvas.getContext("2d")?.drawImage(this.layer, 0, 0);
    this.done(places);
  }
}

/**
 * The tracks of the last minutes, drawn without tiles. A click on a boat selects it; a boat that the pointer is on, or
 * that is `pointedAt` elsewhere, has its name.
 */
export function TrackMap({ tracks, selected, pointedAt, select, label }: {
  tracks: Track[];
  selected?: string;
  pointedAt?: string;
  select?: (id: string) => void;
  label: string;
}) {
  const canvas = useRef<HTMLCanvasElement>(null);
  const [map, setMap] = useState<Box>({ left: 0, top: 0, width: 0, height: 0 });
  const [places, setPlaces] = useState<Place[]>([]);
  const [hovered, setHovered] = useState<string>();
  const [schemes, setSchemes] = useState(0);  // counts light and dark
  useEffect(() => {
    if (!canvas.current) return;
    const observer = new ResizeObserver(([entry]) => {
      const { width, height } = entry!.contentRect;
      setMap({ left: 0, top: 0, width, height });
    });
    observer.observe(canvas.current);
    const scheme = matchMedia("(prefers-color-scheme: dark)");
    const redraw = () => setSchemes((count) => count + 1);
    scheme.addEventListener("change", redraw);
    return () => {
      observer.disconnect();
      scheme.removeEventListener("change", redraw);
    };
  }, []);
  // What comes while a drawing is under way waits for its end: otherwise none would end on a slow machine.
  const drawing = useRef<Drawing | null>(null);
  const next = useRef<(() => Drawing) | null>(null);
  const drawNext = () => {
    drawing.current = next.current?.() ?? null;
    next.current = null;
    drawing.current?.start();
  };
  useEffect(() => {
    next.current = () => new Drawing(canvas.current!, tracks, selected, (found) => {
      setPlaces(found);
      drawNext();
    });
    if (!drawing.current) drawNext();
  }, [tracks, selected, map, schemes]);
  useEffect(() => () => drawing.current?.stop(), []);
  const first = hovered ?? pointedAt;
  const names = useMemo(() => placeNames(places, map, cornersOf(map), [first, selected]), [places, map, first, selected]);
  const click = (event: MouseEvent) => {
    const boat = boatAt(places, event);
    if (boat) select?.(boat);
  };
  const positioned = tracks.some((track) => track.latitudeDeg.length > 0);
  return (
    <div class={positioned ? "map" : "map blank"}>
      <canvas ref={canvas} role="img" aria-label={label} class={hovered && select ? "over-boat" : ""} onClick={click}
        onPointerMove={(event) => setHovered(boatAt(places, event))} onPointerLeave={() => setHovered(undefined)} />
      <MapNames names={names} pointedAt={first} />
      {!positioned && <p class="empty">No position has arrived yet.</p>}
    </div>
  );
}

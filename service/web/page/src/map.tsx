import { useEffect, useRef, useState } from "preact/hooks";
import type { Verdict } from "./api";

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
const kNamedAtMost = 30;
const kLeastStepPx = 1.5;  // a shorter one is not seen, and a large fleet has many
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

interface Place {
  id: string;
  x: number;
  y: number;
  headingDeg?: number;
}

/** Where the boats are on the canvas. */
function placesOf(tracks: Track[], to: Projection): Place[] {
  return tracks.flatMap(({ id, latitudeDeg, longitudeDeg, headingDeg }) => {
    const latitude = latitudeDeg.at(-1);
    const longitude = longitudeDeg.at(-1);
    return latitude === undefined || longitude === undefined ? []
      : [{ id, x: to.x(longitude), y: to.y(latitude), headingDeg }];
  });
}

function drawNames(context: CanvasRenderingContext2D, places: Place[], width: number, surface: string, ink: string) {
  context.lineWidth = 3;
  context.strokeStyle = surface;
  context.fillStyle = ink;
  for (const { id, x, y } of places) {
    const length = context.measureText(id).width;
    const left = x + 11 + length <= width - 4 ? x + 11 : Math.max(4, x - 11 - length);
    context.strokeText(id, left, y + 4);
    context.fillText(id, left, y + 4);
  }
}

/** All boats of one verdict at once: a canvas draws one long path in a fraction of the time of a thousand short ones. */
function drawBoats(context: CanvasRenderingContext2D, tracks: Track[], to: Projection, lineWidth: number, ink: string, surface: string) {
  const paths = new Path2D();
  for (const track of tracks) addTrack(paths, track, to);
  context.strokeStyle = context.fillStyle = ink;
  context.globalAlpha = 0.75;
  context.lineWidth = lineWidth;
  context.lineJoin = "round";
  context.stroke(paths);
  context.globalAlpha = 1;
  const boats = new Path2D();
  for (const place of placesOf(tracks, to)) addBoat(boats, place);
  context.fill(boats);
  context.strokeStyle = surface;
  context.lineWidth = 1.5;
  context.stroke(boats);
}

/** Draws the tracks, the most urgent last, and gives back where the boats are. */
function draw(canvas: HTMLCanvasElement, tracks: Track[], selected?: string): Place[] {
  const { clientWidth: width, clientHeight: height } = canvas;
  const ratio = window.devicePixelRatio || 1;
  canvas.width = width * ratio;
  canvas.height = height * ratio;
  const context = canvas.getContext("2d");
  const to = projection(tracks, width, height);
  if (!context || !to) return [];
  const style = getComputedStyle(canvas);
  const colour = (name: string) => style.getPropertyValue(name).trim();
  const [surface, ink, muted] = [colour("--surface"), colour("--ink"), colour("--muted")];
  context.scale(ratio, ratio);
  context.font = "12px system-ui, sans-serif";
  for (const verdict of kLeastUrgentFirst) {
    const others = tracks.filter((track) => track.verdict === verdict && track.id !== selected);
    drawBoats(context, others, to, 1.75, colour(`--${verdict.toLowerCase()}`), surface);
  }
  for (const track of tracks.filter(({ id }) => id === selected)) {
    drawBoats(context, [track], to, 3, colour(`--${track.verdict.toLowerCase()}`), surface);
  }
  const places = placesOf(tracks, to);
  if (tracks.length <= kNamedAtMost) drawNames(context, places, width, surface, ink);
  drawScale(context, to, height, muted);
  drawNorth(context, width, height, muted);
  return places;
}

/** The tracks of the last minutes, drawn without tiles. A click on a boat selects it. */
export function TrackMap({ tracks, selected, select, label }: {
  tracks: Track[];
  selected?: string;
  select?: (id: string) => void;
  label: string;
}) {
  const canvas = useRef<HTMLCanvasElement>(null);
  const places = useRef<Place[]>([]);
  const [, setSize] = useState(0);
  useEffect(() => {
    if (!canvas.current) return;
    const observer = new ResizeObserver(() => setSize((count) => count + 1));
    observer.observe(canvas.current);
    const scheme = matchMedia("(prefers-color-scheme: dark)");
    const redraw = () => setSize((count) => count + 1);
    scheme.addEventListener("change", redraw);
    return () => {
      observer.disconnect();
      scheme.removeEventListener("change", redraw);
    };
  }, []);
  useEffect(() => {
    if (canvas.current) places.current = draw(canvas.current, tracks, selected);
  });
  const click = (event: MouseEvent) => {
    const near = places.current
      .map(({ id, x, y }) => ({ id, distance: Math.hypot(event.offsetX - x, event.offsetY - y) }))
      .sort((a, b) => a.distance - b.distance)[0];
    if (near && near.distance < 24) select?.(near.id);
  };
  const positioned = tracks.some((track) => track.latitudeDeg.length > 0);
  return (
    <div class="map">
      <canvas ref={canvas} role="img" aria-label={label} onClick={click} />
      {!positioned && <p class="empty">No boat has sent a position yet.</p>}
    </div>
  );
}

import { useEffect, useRef, useState } from "preact/hooks";
import type { Verdict } from "./api";

export interface Track {
  id: string;
  verdict: Verdict;
  latitudeDeg: number[];
  longitudeDeg: number[];
  headingDeg?: number;
}

const kMetresPerDegree = 111_320;
const kMarginPx = 36;

interface Projection {
  x: (longitudeDeg: number) => number;
  y: (latitudeDeg: number) => number;
  pixelsPerMetre: number;
}

/** Local tangent plane about the middle of what is shown, north up. */
function projection(tracks: Track[], width: number, height: number): Projection | null {
  const latitudes = tracks.flatMap((track) => track.latitudeDeg);
  const longitudes = tracks.flatMap((track) => track.longitudeDeg);
  if (latitudes.length === 0) return null;
  const range = (values: number[]) => values.reduce<[number, number]>(
    ([low, high], value) => [Math.min(low, value), Math.max(high, value)], [Infinity, -Infinity]);
  const [south, north] = range(latitudes);
  const [west, east] = range(longitudes);
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

function drawBoat(context: CanvasRenderingContext2D, x: number, y: number, headingDeg?: number) {
  context.save();
  context.translate(x, y);
  context.beginPath();
  if (headingDeg === undefined) {
    context.arc(0, 0, 5, 0, 2 * Math.PI);
  } else {
    context.rotate((headingDeg * Math.PI) / 180);
    context.moveTo(0, -10);
    context.lineTo(6, 7);
    context.lineTo(0, 4);
    context.lineTo(-6, 7);
    context.closePath();
  }
  context.fill();
  context.stroke();
  context.restore();
}

function draw(canvas: HTMLCanvasElement, tracks: Track[], selected?: string) {
  const { clientWidth: width, clientHeight: height } = canvas;
  const ratio = window.devicePixelRatio || 1;
  canvas.width = width * ratio;
  canvas.height = height * ratio;
  const context = canvas.getContext("2d");
  if (!context) return [];
  const style = getComputedStyle(canvas);
  const colour = (name: string) => style.getPropertyValue(name).trim();
  context.scale(ratio, ratio);
  context.font = "12px system-ui, sans-serif";
  const to = projection(tracks, width, height);
  if (!to) return [];
  const places: { id: string; x: number; y: number }[] = [];
  const named = tracks.length <= 30;
  const inOrder = [...tracks].sort((a, b) => Number(a.id === selected) - Number(b.id === selected));
  for (const track of inOrder) {
    const last = track.latitudeDeg.length - 1;
    if (last < 0) continue;
    context.strokeStyle = context.fillStyle = colour(`--${track.verdict.toLowerCase()}`);
    context.globalAlpha = 0.75;
    context.lineWidth = track.id === selected ? 3 : 1.75;
    context.lineJoin = "round";
    context.beginPath();
    track.latitudeDeg.forEach((latitude, i) =>
      context.lineTo(to.x(track.longitudeDeg[i] ?? 0), to.y(latitude)));
    context.stroke();
    context.globalAlpha = 1;
    const x = to.x(track.longitudeDeg[last] ?? 0);
    const y = to.y(track.latitudeDeg[last] ?? 0);
    context.strokeStyle = colour("--surface");
    context.lineWidth = 1.5;
    drawBoat(context, x, y, track.headingDeg);
    places.push({ id: track.id, x, y });
  }
  if (named) {
    context.lineWidth = 3;
    context.strokeStyle = colour("--surface");
    context.fillStyle = colour("--ink");
    for (const { id, x, y } of places) {
      const length = context.measureText(id).width;
      const left = x + 11 + length <= width - 4 ? x + 11 : Math.max(4, x - 11 - length);
      context.strokeText(id, left, y + 4);
      context.fillText(id, left, y + 4);
    }
  }
  drawScale(context, to, height, colour("--muted"));
  drawNorth(context, width, height, colour("--muted"));
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
  const places = useRef<{ id: string; x: number; y: number }[]>([]);
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

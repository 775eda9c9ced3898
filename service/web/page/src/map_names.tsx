import type { Verdict } from "./api";
import { urgency } from "./format";

/** Where a boat is on the map, pixels from its upper left corner. */
export interface Place {
  id: string;
  verdict: Verdict;
  x: number;
  y: number;
  headingDeg?: number;
}

/** A part of the map that names keep off. */
export interface Box {
  left: number;
  top: number;
  width: number;
  height: number;
}

type NamedBox = Box & { id: string };

const kFont = "12px system-ui, sans-serif";
const kHeightPx = 16;
const kMarkPx = 8;  // from the middle of a boat to its outline
const kGapPx = 6;
const kMostNames = 30;  // more hide the tracks
const kCellPx = 8;

function overlap(a: Box, b: Box): boolean {
  return a.left < b.left + b.width && b.left < a.left + a.width && a.top < b.top + b.height && b.top < a.top + a.height;
}

const widths = new Map<string, number>();
const ruler = document.createElement("canvas").getContext("2d");

function widthOf(name: string): number {
  let width = widths.get(name);
  if (width === undefined) {
    if (ruler) ruler.font = kFont;
    width = Math.ceil(ruler?.measureText(name).width ?? 0);
    widths.set(name, width);
  }
  return width;
}

/** Right of the boat, left of it, above it and below it. */
function boxesBeside({ id, x, y }: Place): NamedBox[] {
  const width = widthOf(id);
  const away = kMarkPx + kGapPx;
  const corners = [
    [x + away, y - kHeightPx / 2], [x - away - width, y - kHeightPx / 2],
    [x - width / 2, y - away - kHeightPx], [x - width / 2, y + away],
  ];
  return corners.map(([left = 0, top = 0]) => ({ id, left, top, width, height: kHeightPx }));
}

/** Which cells of the map boats take, so that a name need not be held against each of a thousand. */
class Marks {
  private readonly cells = new Set<number>();

  constructor(places: Place[]) {
    for (const { x, y } of places) this.forEachCell(markOf(x, y), (cell) => void this.cells.add(cell));
  }

  areBelow(box: Box): boolean {
    let found = false;
    this.forEachCell(box, (cell) => { found ||= this.cells.has(cell); });
    return found;
  }

  private forEachCell({ left, top, width, height }: Box, visit: (cell: number) => void) {
    for (let row = Math.floor(top / kCellPx); row * kCellPx < top + height; row++) {
      for (let column = Math.floor(left / kCellPx); column * kCellPx < left + width; column++) visit(row * 10_000 + column);
    }
  }
}

function markOf(x: number, y: number): Box {
  const half = kMarkPx / 2;  // cells are wider than what they hold
  return { left: x - half, top: y - half, width: 2 * half, height: 2 * half };
}

/**
 * The boats that get a name, and where it stands: `first` before all, then the most urgent. No name covers another, nor
 * what is `taken`, nor a boat; those of `first` may cover boats. None leaves the map. A boat without room for its name gets none.
 */
export function placeNames(places: Place[], map: Box, taken: Box[], first: (string | undefined)[]): NamedBox[] {
  const rank = ({ id, verdict }: Place) => (first.includes(id) ? first.indexOf(id) - first.length : urgency(verdict));
  const inside = ({ left, top, width, height }: Box) =>
    left >= map.left && top >= map.top && left + width <= map.left + map.width && top + height <= map.top + map.height;
  const marks = new Marks(places);
  const names: NamedBox[] = [];
  for (const place of [...places].sort((a, b) => rank(a) - rank(b))) {
    if (names.length === kMostNames) break;
    const free = boxesBeside(place).filter((box) => inside(box) && ![...taken, ...names].some((other) => overlap(box, other)));
    const name = free.find((box) => !marks.areBelow(box)) ?? (first.includes(place.id) ? free[0] : undefined);
    if (name) names.push(name);
  }
  return names;
}

/** Names over the map. The map's own text and the table say the same to who does not see them. */
export function MapNames({ names, pointedAt }: { names: NamedBox[]; pointedAt?: string }) {
  return (
    <div class="map-names" aria-hidden="true" style={{ font: kFont, lineHeight: `${kHeightPx}px` }}>
      {names.map(({ id, left, top }) => (
        <span key={id} class={id === pointedAt ? "pointed-at" : ""} style={{ transform: `translate(${left}px, ${top}px)` }}>{id}</span>
      ))}
    </div>
  );
}

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

/** The cells of the map that boats take, so that a name need not be held against each of a thousand. */
class Marks {
  private readonly columns: number;
  private readonly rows: number;
  private readonly counts: Uint32Array;  // of each cell's upper left corner: marks in all cells above and left of it

  constructor(places: Place[], { width, height }: Box) {
    this.columns = Math.ceil(width / kCellPx) + 1;
    this.rows = Math.ceil(height / kCellPx) + 1;
    this.counts = new Uint32Array(this.columns * this.rows);
    for (const place of places) this.mark(this.cellsOf(markOf(place)));
    this.sum();
  }

  areBelow(box: Box): boolean {
    const { left, top, right, bottom } = this.cellsOf(box);
    return this.at(right, bottom) - this.at(left, bottom) - this.at(right, top) + this.at(left, top) > 0;
  }

  /** Columns from left to before right and rows from top to before bottom, as far as they are on the map. */
  private cellsOf({ left, top, width, height }: Box) {
    const column = (x: number) => Math.min(Math.max(x, 0), this.columns - 1);
    const row = (y: number) => Math.min(Math.max(y, 0), this.rows - 1);
    return {
      left: column(Math.floor(left / kCellPx)), right: column(Math.ceil((left + width) / kCellPx)),
      top: row(Math.floor(top / kCellPx)), bottom: row(Math.ceil((top + height) / kCellPx)),
    };
  }

  private mark({ left, top, right, bottom }: { left: number; top: number; right: number; bottom: number }) {
    for (let row = top + 1; row <= bottom; row++) {
      for (let column = left + 1; column <= right; column++) this.counts[row * this.columns + column] = this.at(column, row) + 1;
    }
  }

  private sum() {
    for (let row = 1; row < this.rows; row++) {
      let ofRow = 0;
      for (let column = 1; column < this.columns; column++) {
        ofRow += this.at(column, row);
        this.counts[row * this.columns + column] = this.at(column, row - 1) + ofRow;
      }
    }
  }

  private at(column: number, row: number): number {
    return this.counts[row * this.columns + column] ?? 0;
  }
}

function markOf({ x, y }: Place): Box {
  const half = kMarkPx / 2;  // cells are wider than what they hold
  return { left: x - half, top: y - half, width: 2 * half, height: 2 * half };
}

/** `first` before all, then the most urgent. */
function inOrder(places: Place[], first: Set<string | undefined>): Place[] {
  const sought = [...first].flatMap((id) => places.filter((place) => place.id === id));
  const others: Place[][] = [];
  for (const place of places) if (!first.has(place.id)) (others[urgency(place.verdict)] ??= []).push(place);
  return [...sought, ...others.flat()];
}

/**
 * The boats that get a name, and where it stands: `first` before all, then the most urgent. No name covers another, nor
 * what is `taken`, nor a boat; those of `first` may cover boats. None leaves the map. A boat without room for its name gets none.
 */
export function placeNames(places: Place[], map: Box, taken: Box[], first: (string | undefined)[]): NamedBox[] {
  const sought = new Set(first);
  const marks = new Marks(places, map);
  const inside = ({ left, top, width, height }: Box) =>
    left >= map.left && top >= map.top && left + width <= map.left + map.width && top + height <= map.top + map.height;
  const names: NamedBox[] = [];
  const isFree = (box: Box) => inside(box) && !taken.some((other) => overlap(box, other)) && !names.some((other) => overlap(box, other));
  for (const place of inOrder(places, sought)) {
    if (names.length === kMostNames) break;
    const boxes = boxesBeside(place);
    const name = boxes.find((box) => !marks.areBelow(box) && isFree(box)) ?? (sought.has(place.id) ? boxes.find(isFree) : undefined);
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

import type { Verdict } from "./api";

/** JSON writes numbers that are none as text. */
export function number(value: number | string | undefined): number {
  return typeof value === "number" ? value : value === undefined ? NaN : Number(value);
}

/** Three significant digits, without an exponent where that stays short. */
export function significant(value: number, digits = 3): string {
  if (!Number.isFinite(value)) return "–";
  const size = Math.abs(value);
  const text = size !== 0 && (size < 1e-4 || size >= 1e6) ? value.toExponential(digits - 1)
    : size >= 100 ? value.toFixed(0) : Number(value.toPrecision(digits)).toString();
  return text.replaceAll("-", "\u2212");
}

/** "m/s^2" -> "m/s²"; a number without a unit has "1". */
export function unit(text: string): string {
  return text === "1" ? "" : text.replaceAll("^2", "²").replaceAll("^3", "³");
}

export function percent(share: number): string {
  const value = 100 * share;
  if (value > 0 && value < 0.1) return "< 0.1 %";
  return `${value > 0 && value < 1 ? value.toFixed(1) : value.toFixed(0)} %`;
}

export function duration(seconds: number): string {
  if (seconds < 120) return `${Math.max(0, seconds).toFixed(0)} s`;
  if (seconds < 7200) return `${(seconds / 60).toFixed(0)} min`;
  if (seconds < 172800) return `${(seconds / 3600).toFixed(1)} h`;
  return `${(seconds / 86400).toFixed(0)} d`;
}

export function clock(unixS: number): string {
  const time = new Date(unixS * 1000);
  const isToday = time.toDateString() === new Date().toDateString();
  return time.toLocaleString([], isToday
    ? { hour: "2-digit", minute: "2-digit", second: "2-digit", hourCycle: "h23" }
    : { year: "numeric", month: "short", day: "numeric", hour: "2-digit", minute: "2-digit", hourCycle: "h23" });
}

export function clockMinute(unixS: number): string {
  return new Date(unixS * 1000).toLocaleTimeString([], { hour: "2-digit", minute: "2-digit", hourCycle: "h23" });
}

const kUrgency: Record<Verdict, number> = { ERROR: 0, STALE: 1, WARN: 2, OK: 3, UNKNOWN: 4 };

/** ERROR first, as an operator works through them. */
export function urgency(verdict: Verdict): number {
  return kUrgency[verdict];
}

/** "FIRST_ORDER_DYNAMIC" -> "first order dynamic". */
export function words(name: string): string {
  return name.toLowerCase().replaceAll("_", " ");
}

const kVerdictSentences: { [verdict: string]: string } = {
  NO_MATERIAL_GAP: "No material gap",
  EXPLAINED: "Explained",
  PARTLY_EXPLAINED: "Partly explained",
  UNKNOWN_CAUSE: "Unknown cause",
  INSUFFICIENT_DATA: "Insufficient data",
};

export function diagnosisVerdict(verdict: string): string {
  return kVerdictSentences[verdict] ?? words(verdict);
}

const kRegressors: { [symbol: string]: string } = {
  "f:d": "forward thrust, linear",
  "f:d^2": "forward thrust, quadratic",
  "r:d": "reverse thrust, linear",
  "r:d^2": "reverse thrust, quadratic",
  "1": "constant disturbance",
};

/** The regressor in words where it has some. */
export function regressor(symbol: string): string {
  return kRegressors[symbol] ?? symbol;
}

/** "it diverges" -> "It diverges."; nothing stays nothing. */
export function asSentence(text: string): string {
  return text && `${text.charAt(0).toUpperCase()}${text.slice(1)}.`;
}

import type { ComponentChildren } from "preact";
import type { Job, Verdict } from "./api";
import { percent } from "./format";

const kMarks: { [verdict in Verdict]: string } = { OK: "✓", WARN: "!", ERROR: "✕", STALE: "⌀", UNKNOWN: "?" };

/** A verdict by colour, mark and word, so that none of them is needed alone. */
export function Badge({ verdict }: { verdict: Verdict }) {
  return (
    <span class={`badge ${verdict.toLowerCase()}`}>
      <span aria-hidden="true">{kMarks[verdict]}</span> {verdict}
    </span>
  );
}

/** Text that breaks at blanks alone, so that the options and ids of its commands stay whole. */
export function Text({ children }: { children: string }) {
  return (
    <>{children.split(" ").map((word, place) => (
      <>{place > 0 && " "}{word.includes("-") ? <span class="whole">{word}</span> : word}</>
    ))}</>
  );
}

export function Card({ title, wide, children }: {
  title: string;
  wide?: boolean;
  children: ComponentChildren;
}) {
  return (
    <section class={wide ? "card wide" : "card"} aria-label={title}>
      <h2>{title}</h2>
      {children}
    </section>
  );
}

export function Fact({ name, children }: { name: string; children: ComponentChildren }) {
  return (
    <div class="fact">
      <dt>{name}</dt>
      <dd>{children}</dd>
    </div>
  );
}

/** A share of 1 as a bar with its figure. */
export function Bar({ share, label }: { share: number; label: string }) {
  return (
    <span class="bar">
      <progress value={share} max={1} aria-label={label} />
      <span class="number">{percent(share)}</span>
    </span>
  );
}

const kKinds = { REFRESH: "New model", DIAGNOSE: "Diagnosis", UNKNOWN_KIND: "Request" };

export function JobLine({ job }: { job: Job }) {
  const name = kKinds[job.kind];
  if (job.state === "RUNNING") {
    return (
      <p class="job" role="status">
        {name}: {job.stage || "running"} <Bar share={job.fraction} label={`${name} of ${job.vehicleId}`} />
      </p>
    );
  }
  const outcome = {
    PUBLISHED: job.revision > 0 ? `published as revision ${job.revision}` : "published",
    REFUSED: `refused: ${job.refusals.map((refusal) =>
      `${refusal.subject}: ${refusal.reason}. ${refusal.advice}`).join("; ")}`,
    FAILED: `failed: ${job.message}`,
    UNKNOWN_STATE: "unknown",
  }[job.state];
  return <p class={`job ${job.state.toLowerCase()}`} role="status">{name}: {outcome}</p>;
}

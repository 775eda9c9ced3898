import { useEffect, useState } from "preact/hooks";
import { get } from "./api";

/** Asks the daemon again whenever `when` changes. */
export function useAnswer<T>(route: string, when: unknown): { answer: T | null | undefined; fault: string } {
  const [answer, setAnswer] = useState<T | null | undefined>(undefined);
  const [fault, setFault] = useState("");
  useEffect(() => {
    let wanted = true;
    get<T>(route).then(
      (value) => { if (wanted) { setAnswer(value); setFault(""); } },
      (error: Error) => { if (wanted) setFault(error.message); });
    return () => { wanted = false; };
  }, [route, when]);
  return { answer, fault };
}

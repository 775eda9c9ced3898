import { useEffect, useRef, useState } from "preact/hooks";
import { get } from "./api";

/** Asks the daemon again whenever `when` changes; one question at a time, so that a slow daemon is heard out. */
export function useAnswer<T>(route: string, when: unknown): { answer: T | null | undefined; fault: string } {
  const [answer, setAnswer] = useState<T | null | undefined>(undefined);
  const [fault, setFault] = useState("");
  const wanted = useRef<string | null>(null);  // null: the view is gone
  const due = useRef(false);
  const asking = useRef(false);

  const ask = async () => {
    if (asking.current) return;
    asking.current = true;
    while (due.current && wanted.current !== null) {
      due.current = false;
      const asked = wanted.current;
      const [value, problem] = await get<T>(asked).then(
        (given) => [given, ""] as const,
        (error: Error) => [undefined, error.message] as const);
      if (wanted.current !== asked) continue;
      if (problem === "") setAnswer(value);
      setFault(problem);
    }
    asking.current = false;
  };
  useEffect(() => {
    wanted.current = route;
    due.current = true;
    ask();
  }, [route, when]);
  useEffect(() => () => { wanted.current = null; }, []);
  return { answer, fault };
}

// The page of the studio.
import { element } from "../viewer";
import { Studio } from "./studio";

declare global {
  interface Window { studio?: Studio }
}

Studio.open().then((studio) => {
  window.studio = studio;
  element("keys-of-scene").addEventListener("change", () => studio.refreshKeys());
}, (error: unknown) => {
  const problem = element("problem");
  problem.hidden = false;
  problem.textContent = `The studio cannot start: ${error instanceof Error ? error.message : String(error)}`;
});

// The page of `kairos view`: shows the runs that the program put into it.
import { readPage } from "./data";
import { element, Viewer } from "./viewer";

declare global {
  interface Window { kairos: Viewer }
}

try {
  window.kairos = new Viewer(readPage());
} catch (error) {
  const problem = element("problem");
  problem.hidden = false;
  problem.textContent = `This page cannot be shown: ${error instanceof Error ? error.message : String(error)}`;
}

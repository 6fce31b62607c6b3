// The page of `kairos view`: shows the runs that the program put into it.
import { readPage } from "./data";
import { pause } from "./pause";
import { element, Viewer } from "./viewer";

declare global {
  interface Window { kairos: Viewer }
}

async function start(): Promise<void> {
  await pause(); // what the script itself took is long enough
  window.kairos = await Viewer.open(await readPage());
}

start().catch((error: unknown) => {
  const problem = element("problem");
  problem.hidden = false;
  problem.textContent = `This page cannot be shown: ${error instanceof Error ? error.message : String(error)}`;
});

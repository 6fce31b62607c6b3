// The page of the studio.
import { Lessons } from "../lessons/lessons";
import { Play } from "../play/play";
import { element } from "../viewer";
import { bindRooms } from "./rooms";
import { Studio } from "./studio";

declare global {
  interface Window { studio?: Studio; game?: Play; lessons?: Lessons }
}

function playOf(studio: Studio): Play {
  const { viewer } = studio;
  if (!viewer) throw new Error("there is no view to play in");
  return (window.game ??= new Play({
    client: studio.client, viewer,
    open: (text, path) => {
      location.hash = "#scenes";
      void studio.openText(text, path, "");
    },
  }));
}

function lessonsOf(studio: Studio): Lessons {
  const { viewer } = studio;
  if (!viewer) throw new Error("there is no view to show a lesson in");
  return (window.lessons ??= new Lessons(studio.client, viewer));
}

async function start(): Promise<void> {
  const studio = await Studio.open();
  element("keys-of-scene").addEventListener("change", () => studio.refreshKeys());
  const viewed = async () => { if (!studio.viewer) await studio.load("bounce"); };
  bindRooms({
    scenes: { enter: () => studio.comeBack(), leave: () => { studio.mine = false; } },
    "table-tennis": { enter: () => void viewed().then(() => playOf(studio).enter()), leave: () => window.game?.leave() },
    lesson: { enter: (hash) => void viewed().then(() => lessonsOf(studio).enter(hash)), leave: () => window.lessons?.leave() },
  });
  window.studio = studio;
}

start().catch((error: unknown) => {
  const problem = element("problem");
  problem.hidden = false;
  problem.textContent = `The studio cannot start: ${error instanceof Error ? error.message : String(error)}`;
});

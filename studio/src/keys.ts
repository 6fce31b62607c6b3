// Everything by keys that every keyboard has.
import type { Player } from "./player";
import type { Stage } from "./stage";

export interface Actions {
  player: Player;
  stage: Stage;
  setSpeed(factor: number): void;
  toggle(id: string): void;
  nextBody(step: number): void;
  nextTrail(): void;
  view(name: "fit" | "front" | "side" | "top"): void;
}

function viewKey({ stage, view }: Actions, event: KeyboardEvent): boolean {
  if (event.altKey) {
    switch (event.key) {
      case "ArrowLeft": stage.pan(-0.05, 0); return true;
      case "ArrowRight": stage.pan(0.05, 0); return true;
      case "ArrowUp": stage.pan(0, 0.05); return true;
      case "ArrowDown": stage.pan(0, -0.05); return true;
      default: return false;
    }
  }
  switch (event.key.toLowerCase()) {
    case "a": stage.turn(-0.1, 0); return true;
    case "d": stage.turn(0.1, 0); return true;
    case "w": stage.turn(0, 0.1); return true;
    case "s": stage.turn(0, -0.1); return true;
    case "+": stage.zoom(0.9); return true;
    case "-": stage.zoom(1 / 0.9); return true;
    case "0": view("fit"); return true;
    case "1": view("front"); return true;
    case "2": view("side"); return true;
    case "3": view("top"); return true;
    default: return false;
  }
}

function timeKey({ player, setSpeed, toggle, nextBody, nextTrail }: Actions, event: KeyboardEvent): boolean {
  switch (event.key.toLowerCase()) {
    case " ": player.play(!player.playing); return true;
    case "arrowleft": player.frame(-1); return true;
    case "arrowright": player.frame(1); return true;
    case "arrowup": setSpeed(Math.SQRT2); return true;
    case "arrowdown": setSpeed(Math.SQRT1_2); return true;
    case "p": player.event(-1); return true;
    case "n": player.event(1); return true;
    case "home": player.seek(0); return true;
    case "end": player.seek(player.end); return true;
    case "f": toggle("follow"); return true;
    case "b": toggle("boxes"); return true;
    case "g": toggle("fields"); return true;
    case "i": toggle("impacts"); return true;
    case "t": nextTrail(); return true;
    case ",": nextBody(-1); return true;
    case ".": nextBody(1); return true;
    default: return false;
  }
}

/** Keys that a control needs for itself are its own; the scrubber's arrows step frames. */
function taken(event: KeyboardEvent): boolean {
  const target = event.target;
  if (target instanceof HTMLSelectElement) return true;
  if (target instanceof HTMLInputElement && target.type === "range" && target.id !== "scrubber") return true;
  if (target instanceof HTMLInputElement && !["range", "checkbox", "radio"].includes(target.type)) return true;
  if (target instanceof HTMLElement && target.isContentEditable) return true;
  const presses = event.key === " " || event.key === "Enter";
  return presses && target instanceof HTMLElement && target.matches("button, summary, input[type=checkbox]");
}

export function bindKeys(actions: Actions): void {
  document.addEventListener("keydown", (event) => {
    if (event.defaultPrevented || event.ctrlKey || event.metaKey || taken(event)) return;
    if (viewKey(actions, event) || (!event.altKey && timeKey(actions, event))) event.preventDefault();
  });
}

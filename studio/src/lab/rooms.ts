// The rooms of the page: scenes, table tennis, lessons. The address says which: #table-tennis.
import { element } from "../viewer";

export interface Room {
  enter(hash: string): void;
  leave(): void;
}

/** The name of a room by the start of the address behind the #; the first is for all else. */
export function bindRooms(rooms: Record<string, Room>): void {
  const names = Object.keys(rooms);
  let shown = names[0];
  const go = () => {
    const hash = location.hash.slice(1);
    const name = names.slice(1).find((each) => hash.startsWith(each)) ?? names[0];
    if (name !== shown) rooms[shown].leave();
    if (name !== shown || name !== names[0]) {
      shown = name;
      document.body.dataset.room = name === "lesson" ? "lessons" : name;
      window.scrollTo(0, 0);
      rooms[name].enter(hash);
    }
    for (const link of element("rooms").querySelectorAll("a")) {
      if (link.hash.slice(1).startsWith(name)) link.setAttribute("aria-current", "page");
      else link.removeAttribute("aria-current");
    }
  };
  window.addEventListener("hashchange", go);
  go();
}

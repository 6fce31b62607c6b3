// The scrubber and, above it, a tick for every event.
import type { Palette } from "./palette";
import type { Player } from "./player";

export class Timeline {
  constructor(private readonly ticks: HTMLCanvasElement, private readonly scrubber: HTMLInputElement,
              private readonly player: Player, private readonly colour: Palette) {
    scrubber.addEventListener("input", () => {
      player.play(false);
      player.seek(Number(scrubber.value));
    });
  }

  /** Each pixel at most once: 1e5 events cost no more than 1e3. The thumb's half width is inset. */
  draw(): void {
    const { ticks, player } = this;
    this.scrubber.min = String(player.begin);
    this.scrubber.max = String(player.end);
    const ratio = window.devicePixelRatio;
    const width = Math.max(1, Math.round(ticks.clientWidth * ratio));
    const height = Math.max(1, Math.round(ticks.clientHeight * ratio));
    ticks.width = width;
    ticks.height = height;
    const context = ticks.getContext("2d")!;
    const inset = 8 * ratio;
    context.fillStyle = this.colour.impulse;
    let last = -Infinity;
    for (const t of player.instants) {
      const x = Math.round(inset + ((t - player.begin) / Math.max(player.end - player.begin, 1e-300)) * (width - 2 * inset));
      if (x - last < ratio) continue;
      last = x;
      context.fillRect(x, 2 * ratio, Math.max(1, ratio), height - 2 * ratio);
    }
  }

  at(t: number): void {
    if (Number(this.scrubber.value) !== t) this.scrubber.value = String(t);
  }
}

// Long work in slices, between which the page answers and draws.

/** A slice ends with the first piece that is done after so long, ms. */
const slice = 8;

export const pause = (): Promise<void> => new Promise((go) => { setTimeout(go); });

/** Does `work` to its end; a piece of it is what it does up to a `yield`. */
export async function inSlices<T>(work: Generator<void, T>): Promise<T> {
  for (;;) {
    const until = performance.now() + slice;
    do {
      const step = work.next();
      if (step.done) return step.value;
    } while (performance.now() < until);
    await pause();
  }
}

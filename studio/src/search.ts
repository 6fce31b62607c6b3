/** The last index in [begin, end) whose value is below x; begin - 1 if there is none. Sorted values. */
export function before(values: ArrayLike<number>, x: number, begin = 0, end = values.length): number {
  let low = begin - 1;
  let high = end;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (values[middle] < x) low = middle;
    else high = middle;
  }
  return low;
}

/** The first index in [begin, end) whose value is above x; end if there is none. Sorted values. */
export function after(values: ArrayLike<number>, x: number, begin = 0, end = values.length): number {
  let low = begin - 1;
  let high = end;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (values[middle] <= x) low = middle;
    else high = middle;
  }
  return high;
}

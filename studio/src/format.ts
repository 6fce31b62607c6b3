/** Four significant digits, a minus sign that is one, no trailing noise. */
export function number(x: number, digits = 4): string {
  if (!Number.isFinite(x)) return "–";
  if (x === 0) return "0";
  const size = Math.abs(x);
  const text = size >= 1e5 || size < 1e-3
    ? x.toExponential(Math.max(0, digits - 2))
    : String(Number(x.toPrecision(digits)));
  return text.replace("-", "−").replace("e+", "e").replace("e-", "e−");
}

export const seconds = (t: number): string => `${t.toFixed(4)} s`;

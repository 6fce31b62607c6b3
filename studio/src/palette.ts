// Colours that the colour-blind can tell apart (Okabe and Ito 2008), for light and dark pages.

export interface Palette {
  dark: boolean;
  background: string;
  text: string;
  quiet: string;
  fixed: string;
  driven: string;
  free: string[];
  field: string;
  edge: string;
  inside: string;
  normal: string;
  impulse: string;
  joint: string;
  /** Of plots, in order. */
  lines: string[];
}

const light: Palette = {
  dark: false,
  background: "#f4f6f8",
  text: "#1b2127",
  quiet: "#56606b",
  fixed: "#b9c0c7",
  driven: "#e69f00",
  free: ["#0072b2", "#56b4e9"],
  field: "#cc79a7",
  edge: "#3a434d",
  inside: "#d55e00",
  normal: "#00614a",
  impulse: "#b3470a",
  joint: "#8a3a6b",
  lines: ["#0072b2", "#a34500", "#1b2127", "#00785a", "#a04e7e", "#7a5a00", "#3a77a5", "#6b6b6b"],
};

const dark: Palette = {
  dark: true,
  background: "#12171c",
  text: "#e8edf2",
  quiet: "#a3afbb",
  fixed: "#5d6771",
  driven: "#e69f00",
  free: ["#56b4e9", "#2f8fd0"],
  field: "#cc79a7",
  edge: "#aab4be",
  inside: "#ff7a1a",
  normal: "#34d3a6",
  impulse: "#ffa24d",
  joint: "#f2b0d6",
  lines: ["#56b4e9", "#ff8b3d", "#e8edf2", "#2fc79b", "#e39ac3", "#f0e442", "#8fb8d8", "#b0b0b0"],
};

export const palette = (isDark: boolean): Palette => (isDark ? dark : light);

// The two themes, with colours for colour-blind readers (after Okabe and Ito, and Tol's muted
// scheme).

export interface Theme {
  name: "light" | "dark";
  text: string;
  muted: string;
  /** Grid lines. */
  line: string;
  background: string;
  /** Colours for names without a colour of their own, in this order. */
  palette: readonly string[];
}

export const light: Theme = {
  name: "light",
  text: "#1d2430",
  muted: "#5a6473",
  line: "#e1e5eb",
  background: "#ffffff",
  palette: ["#0072b2", "#d55e00", "#009e73", "#b5569a", "#e69f00", "#3a9bd9", "#6b7280", "#8c7a00"],
};

export const dark: Theme = {
  name: "dark",
  text: "#e6e9ef",
  muted: "#9ea8b8",
  line: "#333b48",
  background: "#171b22",
  palette: ["#4aa8e8", "#f0803c", "#2fc49a", "#e08fbe", "#f0b43c", "#9fd4f5", "#a3abb8", "#d6c94a"],
};

/**
 * [light, dark] by family: our algorithms and the paper's of the same kind; then libraries and
 * algorithms from the literature.
 */
const families: Record<string, readonly [string, string]> = {
  auto: ["#1d2430", "#f4f6f9"],
  brute_force: ["#7b8494", "#99a2b0"],
  grid: ["#e69f00", "#f0b43c"],
  sweep_and_prune: ["#0072b2", "#4aa8e8"],
  quadtree: ["#009e73", "#2fc49a"],
  bvh: ["#b5569a", "#e08fbe"],
  boost: ["#3f3a94", "#9d97f0"],
  box2d: ["#3aa6a0", "#5ecdc6"],
  bullet: ["#8a2a55", "#d4719f"],
  cgal: ["#2e7d3c", "#6cc07b"],
  chipmunk: ["#8c7a00", "#d6c94a"],
  // It often wins in the same map as the other structure of its library.
  chipmunk_space_hash: ["#5b7d00", "#a9cf4a"],
  embree: ["#2f86c6", "#9fd4f5"],
  fcl: ["#c05a6b", "#ec93a1"],
  geos: ["#7a4fa3", "#bf9ae0"],
  karras: ["#4a6a2a", "#a5c77f"],
  ode: ["#6e5a46", "#c4a98c"],
  pbsm: ["#a34a1f", "#e8a27c"],
  segmented: ["#274f7d", "#86b1e0"],
  serpa: ["#7d2743", "#e086a6"],
  terdiman: ["#1f6f78", "#74c3cb"],
  two_layer_grid: ["#b0782a", "#e3b777"],
};

/**
 * The family in an algorithm's name: "grid" of grid:cell=2 and of paper_grid, "bullet" of
 * bullet_dbvt.
 */
export function familyOf(algorithm: string): string | undefined {
  const name = (algorithm.split(/[: (,]/, 1)[0] ?? "").replace(/^paper_/, "");
  if (name in families) return name;
  const library = name.split("_", 1)[0] ?? "";
  return library in families ? library : undefined;
}

export function familyColour(algorithm: string, theme: Theme): string | undefined {
  const family = familyOf(algorithm);
  const colours = family === undefined ? undefined : families[family];
  return colours?.[theme.name === "light" ? 0 : 1];
}

/**
 * A colour for each name: its family's if all names are of different families or of one library
 * each. Otherwise, further names of a family get the next free colours of the palette.
 */
export function coloursOf(names: readonly string[], theme: Theme): string[] {
  const taken = new Set<string>();
  const own = names.map((name) => {
    const colour = familyColour(name, theme);
    if (colour === undefined || taken.has(colour)) return undefined;
    taken.add(colour);
    return colour;
  });
  const free = theme.palette.filter((colour) => !taken.has(colour));
  let next = 0;
  const all = free.length > 0 ? free : theme.palette;
  return own.map((colour) => colour ?? all[next++ % all.length] ?? theme.muted);
}

// State of a search by one of the draft's algorithms, drawn over its boxes.
import type { BvhState, GridState, QuadtreeState, Step, StepState, SweepState } from "../engine/types.ts";
import { stepWorld } from "../scene/step_boxes.ts";

const margin = 0.4;

interface Box {
  x: number;
  y: number;
  width: number;
  height: number;
}

function boxAt(boxes: Float32Array, id: number): Box {
  const [left, top, right, bottom] = [...boxes.subarray(4 * id, 4 * id + 4)] as [number, number, number, number];
  return { x: left, y: top, width: right - left, height: bottom - top };
}

function Grid({ grid }: { grid: GridState }) {
  const { world, size, columns, rows, cells, current, span } = grid;
  if (cells.length === 0) return null;
  const place = (column: number, row: number): Box =>
    ({ x: world.left + column * size, y: world.top + row * size, width: size, height: size });
  const inSpan = (column: number, row: number): boolean => span !== undefined &&
    column >= span[0] && column <= span[1] && row >= span[2] && row <= span[3];
  return (
    <g>
      {Array.from({ length: columns * rows }, (_, cell) => {
        const [column, row] = [Math.floor(cell / rows), cell % rows];
        const { x, y, width, height } = place(column, row);
        return (
          <g key={cell}>
            <rect {...{ x, y, width, height }}
              class={`cell ${cell === current ? "current" : ""} ${inSpan(column, row) ? "span" : ""}`} />
            <text x={x + 0.1} y={y + height - 0.1} class="cell-count">{cells[cell]!.length || ""}</text>
          </g>
        );
      })}
    </g>
  );
}

function Sweep({ sweep }: { sweep: SweepState }) {
  if (Number.isNaN(sweep.position)) return null;
  return <line class="sweep-line" x1={sweep.position} x2={sweep.position} y1={-margin} y2={stepWorld.height + margin} />;
}

function Quadtree({ tree }: { tree: QuadtreeState }) {
  return (
    <g>
      {tree.nodes.map(({ box: [left, top, right, bottom], children }, at) => {
        // Nodes at the border are unbounded.
        const [x0, y0] = [Math.max(left, -margin), Math.max(top, -margin)];
        const [x1, y1] = [Math.min(right, stepWorld.width + margin), Math.min(bottom, stepWorld.height + margin)];
        return <rect key={at} class={`cell ${at === tree.current ? "current" : ""} ${children === undefined ? "leaf" : ""}`}
          x={x0} y={y0} width={Math.max(0, x1 - x0)} height={Math.max(0, y1 - y0)} />;
      })}
    </g>
  );
}

function Bvh({ tree }: { tree: BvhState }) {
  return (
    <g>
      {tree.nodes.map(({ box: [left, top, right, bottom], children }, at) =>
        <rect key={at} class={`cell ${tree.current.includes(at) ? "current" : ""} ${children.length === 0 ? "leaf" : ""}`}
          x={left} y={top} width={right - left} height={bottom - top} />)}
      {tree.current.map((at) => {
        const [left, top] = tree.nodes[at]!.box;
        return <text key={at} x={left + 0.1} y={top - 0.1} class="node-name">node {at}</text>;
      })}
    </g>
  );
}

function Structure({ state }: { state: StepState }) {
  switch (state.kind) {
    case "grid": return <Grid grid={state} />;
    case "sweep_and_prune": return <Sweep sweep={state} />;
    case "quadtree": return <Quadtree tree={state} />;
    case "bvh": return <Bvh tree={state} />;
    case "brute_force": return null;
  }
}

/** The world, and cells that extend beyond it. */
function viewBox(state: StepState): string {
  let [right, bottom] = [stepWorld.width as number, stepWorld.height as number];
  if (state.kind === "grid" && state.cells.length > 0) {
    right = Math.max(right, state.world.left + state.columns * state.size);
    bottom = Math.max(bottom, state.world.top + state.rows * state.size);
  }
  return `${-margin} ${-margin} ${right + 2 * margin} ${bottom + 2 * margin}`;
}

export function StepPicture({ boxes, step, found }:
    { boxes: Float32Array; step: Step; found: ReadonlySet<number> }) {
  const { state, pair, outcome } = step;
  const active = state.kind === "sweep_and_prune" ? new Set(state.active) : new Set<number>();
  const point = state.kind === "grid" || state.kind === "quadtree" ? state.point : undefined;
  // Boxes that the tree does not hold yet.
  const stored = state.kind === "quadtree" ? new Set(state.nodes.flatMap((node) => node.boxes)) : undefined;
  const classOf = (id: number): string => {
    if (pair?.includes(id) === true) return `box ${outcome ?? "test"}`;
    if (step.boxes.includes(id)) return "box about";
    if (active.has(id)) return "box active";
    if (stored?.has(id) === false) return "box waiting";
    return found.has(id) ? "box lit" : "box";
  };
  const count = boxes.length / 4;
  // The boxes of the current step are drawn last, over the others.
  const order = Array.from({ length: count }, (_, id) => id)
    .sort((a, b) => Number(step.boxes.includes(a) || pair?.includes(a)) - Number(step.boxes.includes(b) || pair?.includes(b)));
  return (
    <svg class="step-picture" role="img" aria-label={step.text} viewBox={viewBox(state)}>
      <Structure state={state} />
      {order.map((id) => {
        const box = boxAt(boxes, id);
        return (
          <g key={id} class={classOf(id)}>
            <rect {...box} />
            <text x={box.x + 0.12} y={box.y + 0.48}>{id}</text>
          </g>
        );
      })}
      {point !== undefined && <circle class="point" cx={point[0]} cy={point[1]} r={0.14} />}
    </svg>
  );
}

// The state of a search as text: cells, the active list, nodes.
import type { StepState } from "../engine/types.ts";

const list = (ids: readonly number[]): string => ids.length === 0 ? "none" : ids.join(", ");

/** "no box", "box 4", "boxes 4, 5 and 7". */
function boxesOf(ids: readonly number[]): string {
  if (ids.length < 2) return ids.length === 0 ? "no box" : `box ${ids[0]}`;
  return `boxes ${ids.slice(0, -1).join(", ")} and ${ids[ids.length - 1]}`;
}

export function StepStateText({ state }: { state: StepState }) {
  switch (state.kind) {
    case "brute_force":
      return <p>i = {state.i < 0 ? "–" : state.i}, j = {state.j < 0 ? "–" : state.j}</p>;
    case "grid":
      return <p>{state.cells.length === 0 ? "No cells yet." :
        `${state.columns} × ${state.rows} cells of ${Number(state.size.toPrecision(3))}. ` +
        (state.current < 0 ? "" : `This cell holds ${boxesOf(state.cells[state.current] ?? [])}.`)}
        {state.point !== undefined && " The dot is the reference point: the cell that holds it reports the pair."}</p>;
    case "sweep_and_prune":
      return (
        <>
          <p>Active: <b>{list(state.active)}</b></p>
          <ol class="order" aria-label="Boxes by their least x">
            {state.order.map((id, at) => <li key={id} class={at === state.next ? "next" : at < state.next ? "passed" : ""}>{id}</li>)}
          </ol>
        </>
      );
    case "bvh":
      return (
        <>
          <p>{state.nodes.length === 0 ? "No nodes yet." : `${state.nodes.length} nodes; a leaf holds up to ${state.size} boxes, ` +
            `another node up to ${state.size} nodes.`}</p>
          {state.current.map((at) => {
            const { boxes, children } = state.nodes[at]!;
            return <p key={at}>Node {at}: {children.length > 0 ? `nodes ${children.join(", ")}` : boxesOf(boxes)}.</p>;
          })}
        </>
      );
    case "quadtree": {
      const leaves = state.nodes.filter(({ children }) => children === undefined).length;
      const node = state.nodes[state.current];
      return <p>{state.nodes.length} nodes, {leaves} of them leaves; a leaf holds up to {state.capacity}.{" "}
        {node !== undefined && `This node, at depth ${node.depth}, holds ${boxesOf(node.boxes)}.`}
        {state.point !== undefined && " The dot is the reference point: the leaf that holds it reports the pair."}</p>;
    }
  }
}

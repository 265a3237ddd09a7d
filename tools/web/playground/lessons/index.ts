// The lessons, in order.
import { broadPhase } from "./1_broad_phase.tsx";
import { sorting } from "./2_sorting.tsx";
import { cellSize } from "./3_cell_size.tsx";
import { quadtree } from "./4_quadtree.tsx";
import { bvh } from "./5_bvh.tsx";
import { coherence } from "./6_coherence.tsx";
import { choosing } from "./7_choosing.tsx";
import type { Lesson } from "./lesson.ts";

export const lessons: readonly Lesson[] = [broadPhase, sorting, cellSize, quadtree, bvh, coherence, choosing];

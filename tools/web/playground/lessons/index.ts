// The five lessons, in order.
import { broadPhase } from "./1_broad_phase.tsx";
import { sorting } from "./2_sorting.tsx";
import { cellSize } from "./3_cell_size.tsx";
import { coherence } from "./4_coherence.tsx";
import { choosing } from "./5_choosing.tsx";
import type { Lesson } from "./lesson.ts";

export const lessons: readonly Lesson[] = [broadPhase, sorting, cellSize, coherence, choosing];

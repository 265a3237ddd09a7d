// The page: its head, and the text, pictures and controls of each of its parts.
import { lessons } from "../lessons/index.ts";
import type { Mode } from "../state/state.ts";
import { patch, said, state } from "../state/store.ts";
import { address } from "./address.ts";
import { AlgorithmCard } from "./algorithm_card.tsx";
import { ChallengeCard } from "./challenge_card.tsx";
import { hovering } from "./drop.ts";
import { Legend } from "./legend.tsx";
import { LessonExercise, LessonText, openLesson } from "./lesson_view.tsx";
import { SceneCard } from "./scene_card.tsx";
import { Shadows } from "./shadows.tsx";
import { ShareCard } from "./share_card.tsx";
import type { Stage } from "./stage.ts";
import { StageView } from "./stage_view.tsx";
import { StepsView } from "./steps_view.tsx";
import { chosenTheme, theme } from "./themes.ts";
import { TimesCard } from "./times_card.tsx";
import { Transport } from "./transport.tsx";

const modes: readonly { mode: Mode; label: string }[] = [
  { mode: "play", label: "Play" }, { mode: "steps", label: "Step by step" }, { mode: "lesson", label: "Lessons" },
];

function Head() {
  const { mode, lesson } = state.value;
  return (
    <header class="top">
      <p class="brand">
        <svg viewBox="0 0 24 24" width="22" height="22" aria-hidden="true">
          <path d="M3 3h11v11H3z M10 10h11v11H10z" fill="none" stroke="currentColor" stroke-width="2" />
        </svg>
        <span>Broadside</span>
      </p>
      <nav aria-label="Parts of the playground">
        {modes.map((one) => (
          <button key={one.mode} type="button" aria-current={one.mode === mode ? "page" : undefined}
            onClick={() => one.mode === "lesson" ? openLesson(lesson) : patch({ mode: one.mode })}>{one.label}</button>
        ))}
      </nav>
      <button type="button" class="quiet" onClick={() => { chosenTheme.value = theme.value === "dark" ? "light" : "dark"; }}>
        {theme.value === "dark" ? "Light theme" : "Dark theme"}</button>
    </header>
  );
}

function Embedded({ stage }: { stage: Stage }) {
  const { mode } = state.value;
  return (
    <main id="main" class="embedded">
      <h1 class="unseen">Broadside playground</h1>
      {mode === "steps" ? <StepsView /> : <StageView stage={stage} />}
      <footer class="row">
        {mode !== "steps" && <button type="button" class="strong" onClick={() => patch({ playing: !state.value.playing })}>
          {state.value.playing ? "Pause" : "Play"}</button>}
        <a href={address().replace(/(&|#)embed$/, "")} target="_blank" rel="noopener">Open in the playground</a>
      </footer>
    </main>
  );
}

function Figure({ stage }: { stage: Stage }) {
  const { mode, lesson } = state.value;
  return (
    <div class="left">
      <StageView stage={stage} />
      {mode === "lesson" && lessons[lesson]!.drawsShadows && <Shadows stage={stage} />}
      <Legend />
      <Transport />
    </div>
  );
}

export function App({ stage }: { stage: Stage }) {
  const { mode, embed, panels } = state.value;
  const speaking = <div class="unseen" role="status" aria-live="polite">{said.value}</div>;
  if (embed) return <><Embedded stage={stage} />{speaking}</>;
  return (
    <>
      <a class="skip" href="#main" onClick={(event) => {
        event.preventDefault();
        document.getElementById("main")?.focus();
      }}>Skip to the picture</a>
      <Head />
      <main id="main" tabIndex={-1} class={`${mode} ${mode === "play" && panels.length > 1 ? "wide" : ""}`}>
        {mode === "steps" && <StepsView />}
        {mode === "lesson" && <><LessonText /><Figure stage={stage} /><LessonExercise /></>}
        {mode === "play" && (
          <>
            <header class="intro">
              <h1>Which boxes overlap?</h1>
              <p>A broad phase finds every pair of boxes that overlap, with as few tests as it can. Watch Broadside's
                algorithms at work: drag a box, choose an algorithm, and see which boxes it compares.</p>
            </header>
            <Figure stage={stage} />
            <aside class="right" aria-label="Settings">
              <SceneCard />
              <AlgorithmCard />
            </aside>
            <div class="more">
              <TimesCard />
              <ChallengeCard />
              <ShareCard stage={stage} />
            </div>
          </>
        )}
      </main>
      {hovering.value && <div class="drop-here" aria-hidden="true">Drop a CSV, trace, PLY, OBJ or GeoJSON</div>}
      {speaking}
    </>
  );
}

"""Threads, signals, forks, interpreters and leaks."""

import gc
import multiprocessing
import os
import resource
import signal
import subprocess
import sys
import textwrap
import threading

import numpy as np
import pytest
from conftest import scattered

import broadside

# Few pairs, and far more work than anyone waits for: brute force takes minutes.
FEW_PAIRS = scattered(1_000_000, 3, size=0.01)


def run(code):
    """In an interpreter of its own."""
    return subprocess.run([sys.executable, "-c", textwrap.dedent(code)], capture_output=True, text=True, timeout=120)


def interrupted_after(seconds, call):
    """Has Ctrl-C come meanwhile, which the call must let through."""
    timer = threading.Timer(seconds, lambda: os.kill(os.getpid(), signal.SIGINT))
    timer.start()
    try:
        with pytest.raises(KeyboardInterrupt):
            call()
    finally:
        timer.join()


@pytest.mark.parametrize("threads", [1, 2])
@pytest.mark.parametrize("call", [broadside.pairs, broadside.count])
def test_ctrl_c_ends_a_search_that_finds_few_pairs(call, threads):
    interrupted_after(0.3, lambda: call(FEW_PAIRS, algorithm="brute_force", threads=threads))
    # and the next one is whole
    assert broadside.count(FEW_PAIRS[:1000]) == len(broadside.pairs(FEW_PAIRS[:1000], algorithm="brute_force"))


def test_ctrl_c_ends_a_search_that_finds_many_pairs():
    coincident = np.tile(np.array([[0, 0, 1, 1]], np.float32), (25_000, 1))
    interrupted_after(0.1, lambda: [broadside.pairs(coincident) for _ in range(1000)])


def test_ctrl_c_ends_queries_and_updates():
    index = broadside.Index(FEW_PAIRS[:1000])
    interrupted_after(0.3, lambda: index.nearest(np.zeros((4_000_000, 3), np.float32), 20))
    world = broadside.World(3, dtype=np.float32, algorithm="brute_force")
    handles = world.add(FEW_PAIRS[:400_000])
    interrupted_after(0.3, lambda: world.update())
    world.remove(handles[1000:])
    assert len(world.update().begun) == broadside.count(FEW_PAIRS[:1000])


def test_ctrl_c_ends_a_join():
    worlds = [broadside.World(3, dtype=np.float32, algorithm="brute_force") for _ in range(2)]
    for world in worlds:
        world.add(FEW_PAIRS[:400_000])
    interrupted_after(0.3, lambda: worlds[0].join(worlds[1]))


def test_a_signal_handler_may_not_call_the_object_that_it_interrupts():
    world = broadside.World(3, dtype=np.float32, algorithm="brute_force")
    world.add(FEW_PAIRS[:400_000])
    before = signal.signal(signal.SIGALRM, lambda *_: world.update())
    try:
        signal.setitimer(signal.ITIMER_REAL, 0.2)
        with pytest.raises(RuntimeError, match="a signal handler called the object"):
            world.update()
    finally:
        signal.signal(signal.SIGALRM, before)


def test_other_threads_run_meanwhile():
    began, ran = threading.Event(), threading.Event()

    def interrupt():
        began.wait()
        ran.set()
        os.kill(os.getpid(), signal.SIGINT)

    thread = threading.Thread(target=interrupt)
    interval = sys.getswitchinterval()
    thread.start()
    try:
        # From here on Python gives the GIL to another thread only where one lets it go, as the search does, which
        # would take minutes if the other thread could not end it.
        sys.setswitchinterval(1000)
        with pytest.raises(KeyboardInterrupt):
            began.set()
            assert not ran.is_set()
            broadside.count(FEW_PAIRS, algorithm="brute_force")
    finally:
        sys.setswitchinterval(interval)
    thread.join()
    assert ran.is_set()


def test_a_hundred_threads_search_at_once():
    boxes = [scattered(20_000, seed=seed) for seed in range(4)]
    expected = [broadside.pairs(b, threads=1) for b in boxes]
    index = broadside.Index(boxes[0])
    answers = index.overlapping(boxes[1])
    wrong = []
    barrier = threading.Barrier(100)

    def work(i):
        barrier.wait()
        try:
            np.testing.assert_array_equal(broadside.pairs(boxes[i % 4], threads=1 + i % 3), expected[i % 4])
            np.testing.assert_array_equal(index.overlapping(boxes[1]).box, answers.box)
        except BaseException as error:
            wrong.append(error)

    threads = [threading.Thread(target=work, args=(i,)) for i in range(100)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not wrong


def search_in_child(queue):
    queue.put(broadside.pairs(scattered(50_000), threads=2))


def test_searches_in_a_forked_process():
    here = broadside.pairs(scattered(50_000), threads=2)
    context = multiprocessing.get_context("fork")
    queue = context.Queue()
    child = context.Process(target=search_in_child, args=(queue,))
    child.start()
    there = queue.get(timeout=60)
    child.join(timeout=60)
    assert child.exitcode == 0
    np.testing.assert_array_equal(here, there)


def test_a_subinterpreter_searches_or_says_why_not():
    done = run(
        """
        try:
            import _interpreters as interpreters
        except ImportError:
            import _xxsubinterpreters as interpreters
        import broadside
        code = '''
        try:
            import broadside
            assert broadside.count([[0, 0, 1, 1], [1, 1, 2, 2]]) == 1
        except ImportError as error:
            assert str(error)
        '''
        import textwrap
        one = interpreters.create()
        failure = interpreters.run_string(one, textwrap.dedent(code))
        assert failure is None, failure
        interpreters.destroy(one)
        assert broadside.count([[0, 0, 1, 1], [1, 1, 2, 2]]) == 1
        print("done")
        """
    )
    assert done.stdout == "done\n", done.stderr


def test_the_process_ends_while_a_thread_searches():
    done = run(
        """
        import threading, time, numpy as np, broadside
        boxes = np.random.default_rng(1).random((400_000, 3)).astype("f4")
        boxes = np.hstack([boxes, boxes])
        threading.Thread(target=lambda: broadside.count(boxes, algorithm="brute_force"), daemon=True).start()
        time.sleep(0.3)
        """
    )
    assert done.returncode == 0, done.stderr


def test_a_finalizer_calls_a_world_while_python_ends():
    done = run(
        """
        import broadside
        class Keeper:
            def __init__(self):
                self.world = broadside.World(2)
                self.world.add([[0, 0, 1, 1]])
            def __del__(self):
                print(len(self.world), flush=True)
        keeper = Keeper()
        """
    )
    assert (done.returncode, done.stdout) == (0, "1\n"), done.stderr


def test_first_calls_of_several_threads_wait_for_nothing():
    done = run(
        """
        import builtins, sys, threading, time, numpy as np, broadside
        plain = builtins.__import__
        def slow(*arguments, **named):  # lets other threads run
            time.sleep(0.01)
            return plain(*arguments, **named)
        builtins.__import__ = slow
        boxes = np.array([[0, 0, 2, 2], [1, 1, 3, 3.0]])
        threads = [threading.Thread(target=broadside.pairs, args=(boxes,)) for _ in range(4)]
        [thread.start() for thread in threads]
        [thread.join() for thread in threads]
        print("done")
        """
    )
    assert done.stdout == "done\n", done.stderr


def test_nothing_is_leaked():
    boxes = scattered(3000, dtype=np.float64)
    bad = boxes.copy()
    bad[5] = np.nan

    def once():
        broadside.pairs(boxes, output="numpy")
        broadside.pairs(boxes.astype(int))
        broadside.pairs(boxes, output="arrow").__arrow_c_stream__()
        broadside.pairs(boxes, output="arrow").__arrow_c_array__()
        index = broadside.Index(boxes)
        index.nearest(boxes[:, :2], 3)
        world = broadside.World(2)
        handles = world.add(boxes, filters=broadside.filters(3000))
        world.update()
        world.restore(world.snapshot())
        world.remove(handles)
        world.update()
        tracker = broadside.Tracker(2)
        tracker.update(boxes)
        for call in (broadside.pairs, broadside.Index, world.add, tracker.update):
            with pytest.raises(broadside.InvalidBoxError):
                call(bad)

    for _ in range(5):
        once()
    gc.collect()
    references = sys.getrefcount(boxes), sys.getrefcount(bad), sys.getrefcount(None)
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    for _ in range(60):
        once()
    gc.collect()
    assert (sys.getrefcount(boxes), sys.getrefcount(bad)) == references[:2]
    assert abs(sys.getrefcount(None) - references[2]) < 50 or sys.version_info >= (3, 12)
    # Sixty times what is kept at once would be some hundred megabytes.
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - memory < 20_000


def test_an_array_may_be_resized_once_it_was_searched():
    boxes = scattered(100)
    broadside.pairs(boxes)
    broadside.Index(boxes)
    boxes.resize((50, 4), refcheck=False)
    backing = bytearray(scattered(10).tobytes())
    broadside.pairs(np.frombuffer(backing, np.float32).reshape(10, 4))
    gc.collect()
    backing.append(0)

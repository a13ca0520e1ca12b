"""Long calls: progress, Ctrl-C, threads, processes."""
import multiprocessing
import os
import signal
import threading
import time

import facet
import numpy as np
import pytest

LONG = {"size": 512, "renderer": "path", "samples": 4096}


def test_progress_and_cancelling(scene):
    seen = []
    scene.render(size=64, progress=lambda stage, fraction: seen.append((stage, fraction)))
    assert seen and all(isinstance(stage, str) and 0 <= fraction <= 1 for stage, fraction in seen)
    with pytest.raises(facet.CancelledError):
        scene.render(**LONG, progress=lambda stage, fraction: False)


def test_exceptions_of_callbacks(scene, tmp_path):
    def fail(*_):
        raise KeyError("from the callback")

    with pytest.raises(KeyError, match="from the callback"):
        scene.render(**LONG, progress=fail)
    (tmp_path / "a.obj").write_text("mtllib missing.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    with pytest.raises(KeyError, match="from the callback"):
        facet.load(tmp_path / "a.obj", log=fail)


INTERRUPTED = """
import os, signal, sys, threading, time
import facet
scene = facet.Scene.builtin()
def interrupt():
    global sent
    sent = time.monotonic()
    os.kill(os.getpid(), signal.SIGINT)
timer = threading.Timer(0.5, interrupt)
timer.start()
try:
    scene.render(size=512, renderer="path", samples=4096 {progress})
    sys.exit("not interrupted")
except KeyboardInterrupt:
    took = time.monotonic() - sent
image = scene.render(size=16, samples=1)  # all is well afterwards
assert image.size == (16, 16)
print(took)
"""


@pytest.mark.parametrize("progress", ["", ", progress=lambda stage, fraction: None"])
def test_ctrl_c(script, progress):
    result = script(INTERRUPTED.format(progress=progress))
    assert result.returncode == 0, result.stderr
    assert "ignored" not in result.stderr, result.stderr
    assert float(result.stdout) < (0.5 if os.cpu_count() > 2 else 1.5)  # .5 s on a quiet machine


def test_the_gil_is_free_during_a_render(scene):
    steps, ended = [0], threading.Event()

    def count():
        while not ended.wait(0.001):
            steps[0] += 1

    thread = threading.Thread(target=count)
    thread.start()
    scene.render(size=256, samples=64, threads=1)
    ended.set()
    thread.join()
    assert steps[0] > 20


def test_eight_threads_at_once(scene):
    wanted = [scene.render(size=32, samples=1, camera=facet.Orbit(azimuth_rad=a)).pixels for a in range(8)]
    found, errors = [None] * 8, []

    def work(i):
        try:
            with facet.Renderer(scene) as renderer:
                for _ in range(3):
                    found[i] = renderer.render(size=32, samples=1, camera=facet.Orbit(azimuth_rad=i)).pixels
        except BaseException as error:
            errors.append(error)

    threads = [threading.Thread(target=work, args=(i,)) for i in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not errors
    for a, b in zip(wanted, found):
        np.testing.assert_array_equal(a, b)


def test_changes_during_a_render_are_refused():
    scene = facet.Scene.builtin()
    caught = []

    def change(*_):
        try:
            scene.place(np.eye(4))
        except RuntimeError as error:
            caught.append(str(error))

    scene.render(size=32, samples=1, progress=change)
    assert caught and "in use by another call" in caught[0]
    scene.place(np.eye(4))


def _render_in_child(queue):
    queue.put(facet.Scene.builtin().render(size=16, samples=1).pixels.sum())


def test_a_forked_process_renders(scene):
    wanted = scene.render(size=16, samples=1).pixels.sum()
    context = multiprocessing.get_context("fork")
    queue = context.SimpleQueue()
    process = context.Process(target=_render_in_child, args=(queue,))
    process.start()
    process.join(30)
    assert process.exitcode == 0 and queue.get() == wanted


def test_calls_cost_less_than_a_millisecond(scene):
    image = scene.render(size=8, samples=1)

    def seconds(call, count=50):
        times = []
        for _ in range(count):
            start = time.perf_counter()
            call()
            times.append(time.perf_counter() - start)
        return sorted(times)[len(times) // 2]

    assert seconds(lambda: image.pixels) < 1e-3
    assert seconds(lambda: facet.thread_count()) < 1e-3
    call = facet._calls.Call()
    assert seconds(lambda: call.run(lambda: None)) < 1e-3  # a thread of its own
    request = facet._render.Request
    assert seconds(lambda: request(scene, "render", size=8, samples=1, tonemap="agx", path={"denoises": True})) < 1e-3


def test_memory_is_released(scene):
    def resident():
        with open("/proc/self/statm") as file:
            return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")

    for _ in range(3):
        scene.render(size=512, samples=1)
    before = resident()
    for _ in range(20):  # 4 MiB each
        scene.render(size=512, samples=1).to_uint8()
    assert resident() - before < 30e6


def test_signals_reach_other_handlers(scene):
    called = []
    old = signal.signal(signal.SIGUSR1, lambda *_: called.append(True))
    try:
        threading.Timer(0.05, lambda: os.kill(os.getpid(), signal.SIGUSR1)).start()
        scene.render(size=256, samples=16)
        time.sleep(0.1)
    finally:
        signal.signal(signal.SIGUSR1, old)
    assert called

"""Long calls: progress, messages, Ctrl-C, and objects whose C counterpart is released once.

A long call runs in a thread of its own while the main thread waits. Python delivers Ctrl-C to the main thread only; were
the call there, KeyboardInterrupt could strike inside of the progress callback, where ctypes drops it. The thread that waits
can be interrupted at any time: it tells the callback to cancel, waits a moment for the call to end, and raises. A call that goes
on, as it has no progress or reports it rarely, keeps what it needs and releases what it makes.
"""
import os
import sys
import threading
import warnings
import weakref
from contextlib import contextmanager

from . import _api
from ._library import FacetWarning

_REPORT = dict(_api.facet_progress._fields_)["report"]
_PATIENCE_S = 0.3
_PACKAGE = os.path.dirname(__file__)
_MESSAGE = dict(_api.facet_log._fields_)["message"]


class Call:
    """The callbacks of one call of the library. Keep it until the call has ended."""

    def __init__(self, desc=None, progress=None, log=None):
        self.progress, self.log = progress, log
        self.stopped = False
        self.error = None
        self.messages = []
        self.can_stop = False
        fields = dict(desc._fields_) if desc is not None else {}
        if "progress" in fields:
            self.can_stop = True
            self._report = desc.progress.report = _REPORT(self._on_progress)
        if "log" in fields:
            self._message = desc.log.message = _MESSAGE(self._on_message)

    def _on_progress(self, _user, stage, fraction):
        if self.stopped:
            return False
        if self.progress is not None and self.error is None:
            try:
                if self.progress(stage.decode(), fraction) is False:
                    self.stopped = True
            except BaseException as error:  # raised again when the call has ended
                self.error = error
        return not self.stopped and self.error is None

    def _on_message(self, _user, level, text):
        text = text.decode("utf-8", "replace")
        if self.log is not None:
            try:
                self.log(_api.LogLevel(level), text)
            except BaseException as error:
                self.error = self.error or error
        elif level == _api.LogLevel.WARNING:
            self.messages.append(text)

    def run(self, work, discard=None):
        """work() in a thread, so that Ctrl-C ends it. discard(result) releases what an interrupted call made."""
        if threading.current_thread() is threading.main_thread():
            result, error = self._run_in_thread(work, discard)
        else:
            result, error = _outcome(work)
        if self.error is not None:
            _discard(discard, result)
            raise self.error from None
        for text in self.messages:
            warnings.warn(text, FacetWarning, stacklevel=_caller())
        if error is not None:
            raise error
        return result

    def _run_in_thread(self, work, discard):
        outcome, ended, abandoned = [], threading.Event(), threading.Event()

        def body():
            outcome.append(_outcome(work))
            ended.set()
            if abandoned.is_set():
                self._release(outcome, discard)

        threading.Thread(target=body, daemon=True, name="facet").start()
        try:
            ended.wait()
        except BaseException:
            self.stopped = True
            try:
                if self.can_stop:
                    ended.wait(_PATIENCE_S)
            finally:
                abandoned.set()
                if ended.is_set():
                    self._release(outcome, discard)
            raise
        return outcome[0]

    _lock = threading.Lock()

    def _release(self, outcome, discard):
        with Call._lock:
            result, _ = outcome.pop() if outcome else (None, None)
        _discard(discard, result)


def _caller():
    """The stack level of the code that called the package, as seen from the function that calls this one."""
    level, frame = 1, sys._getframe(1)
    while frame.f_back is not None and os.path.dirname(frame.f_code.co_filename) == _PACKAGE:
        level, frame = level + 1, frame.f_back
    return level


def _outcome(work):
    try:
        return work(), None
    except BaseException as error:
        return None, error


def _discard(discard, result):
    if discard is not None and result is not None:
        discard(result)


class _Owner:
    """A pointer that is released when the last handle that needs it is gone. Any number of calls may read its object at
    once, or one may change it."""

    def __init__(self, pointer, destroy, needs):
        self.pointer = pointer
        self.release = weakref.finalize(self, _destroy, destroy, pointer, needs)
        self.release.atexit = False  # a call that was interrupted may still use it; the system takes the memory back
        self.lock = threading.Lock()
        self.readers, self.is_changing = 0, False


def _destroy(destroy, pointer, _needs):
    destroy(pointer)


class Handle:
    """An object of the library. It is released by close(), at the end of a `with` block, or when nothing refers to it any
    more."""

    _destroy = None  # the function of the library that releases it
    _owner = None

    def __init__(self, *_, **__):
        raise TypeError(f"a facet.{type(self).__name__} is made by {self._makers}")

    def __reduce__(self):
        raise TypeError(f"a facet.{type(self).__name__} cannot be pickled: its memory is the library's; pass a path, bytes or "
                        "an array, and make it from that")

    def __copy__(self):
        twin = type(self).__new__(type(self))
        twin.__dict__.update(self.__dict__)
        return twin

    def _own(self, pointer, *needs):
        """needs: handles whose objects must outlive this one."""
        self._owner = _Owner(pointer, type(self)._destroy, [handle._living for handle in needs])

    @classmethod
    def _adopt(cls, pointer, *needs):
        handle = cls.__new__(cls)
        handle._own(pointer, *needs)
        return handle

    def _alias(self):
        """Another handle of the same object, which closing this one leaves alone."""
        handle = type(self).__new__(type(self))
        handle._owner = self._living
        return handle

    @property
    def _living(self):
        if self._owner is None:
            raise ValueError(f"this {type(self).__name__} is closed")
        return self._owner

    @property
    def _pointer(self):
        return self._living.pointer

    @contextmanager
    def _reading(self):
        owner = self._living
        with owner.lock:
            if owner.is_changing:
                raise RuntimeError(f"another thread is changing this {type(self).__name__}")
            owner.readers += 1
        try:
            yield owner.pointer
        finally:
            with owner.lock:
                owner.readers -= 1

    @contextmanager
    def _changing(self):
        owner = self._living
        with owner.lock:
            if owner.readers or owner.is_changing:
                raise RuntimeError(f"this {type(self).__name__} is in use by another call; change it afterwards")
            owner.is_changing = True
        try:
            yield owner.pointer
        finally:
            with owner.lock:
                owner.is_changing = False

    def close(self):
        """Releases the memory of the library, as soon as no call and no other object needs it. Closing twice is allowed."""
        self._owner = None

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

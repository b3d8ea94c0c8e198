"""Cases of a sweep on workers of Dask that come, go and die. `roulement.sweep` calls this, and workers do.

How many tasks the scheduler has follows its workers, so that a cluster may start empty and grow; how many cases are in a task follows
the time that they take.
"""

import queue
import time

from . import _native

VERSION = _native.version()
"""Version of the program that rows of cases come from, with revision and platform."""

AHEAD = 3
"""Tasks with the scheduler for every thread of the workers: one that runs, and some for workers that end theirs before the client looks."""
FIRST = 4
"""Tasks with the scheduler where there is no worker yet: clusters that adapt start workers for tasks alone."""
AIM = 10.0
"""How long a task should take [s]: scheduler and client have some ms of work with each, and what is lost with a worker is small."""
LONGEST = 20.0
"""After how long a task gives back the cases that it has not begun [s]."""
MOST = 2000
"""Most cases of a task: a scene has some kB."""
LOOK = 1.0
"""How often the workers are counted [s]."""

class Lost(Exception):
    """Tasks that the scheduler knows no more."""


def batch_rows(cases, wanted, version, longest):
    """Work of a worker: rows of cases from the texts of their scenes, as many as it has begun within a time [s], and that time.

    A worker of another version gives its version in place of rows; one without the package what it misses.
    """
    import time

    try:
        from roulement import _native
    except ImportError as why:
        return None, f"no roulement ({why})"
    own = getattr(_native, "version", lambda: "an older version")()
    if own != version:
        return None, f"roulement {own}"
    begin = time.monotonic()
    rows = []
    for case, text in cases:
        rows.append((case, _native.case_row(text, **wanted)))
        if time.monotonic() - begin > longest:
            break
    return rows, time.monotonic() - begin


# It is sent as it is, and not by the name of this module: a worker that does not have it would end before it could say so.
batch_rows.__module__ = "__main__"


class Sizes:
    """How many cases the next task gets."""

    def __init__(self, fixed=None):
        self.fixed, self.per_case = fixed, None

    def learn(self, cases, seconds):
        """Takes in what a task has taken; the last ones count most."""
        if cases:
            found = max(seconds / cases, 1e-6)
            self.per_case = found if self.per_case is None else 0.7 * self.per_case + 0.3 * found

    def next(self, left, threads):
        """Cases of a task, of those that are left; in the end all threads have some."""
        if self.fixed:
            return self.fixed
        if self.per_case is None:
            # Nothing is known of their time.
            return 1
        shared = -(-left // (2 * max(1, threads)))
        return max(1, min(int(AIM / self.per_case), shared, MOST))


class Work:
    """Cases that are not with the scheduler, and tasks that are."""

    def __init__(self, client, sweep, cases, wanted, batch):
        self.client, self.sweep, self.wanted = client, sweep, wanted
        self.left, self.sizes = list(reversed(cases)), Sizes(batch)
        # Cases of tasks that the scheduler gave up, as each has ended several workers or was beside one that has.
        self.suspects, self.alone = [], None
        # Those that have ended several workers by themselves.
        self.guilty = []
        self.running, self.ended = {}, queue.SimpleQueue()
        self.threads, self.looked = 0, -LOOK

    def look(self):
        """Counts the threads of the workers, now and then."""
        if time.monotonic() - self.looked >= LOOK:
            self.threads = sum(self.client.nthreads().values())
            self.looked = time.monotonic()

    def submit(self):
        """Gives the scheduler as many tasks as its workers want: a million scenes need not be there. Suspects come last and alone."""
        while self.left and len(self.running) < max(FIRST, AHEAD * self.threads):
            count = self.sizes.next(len(self.left), self.threads)
            self.start([self.left.pop() for _ in range(min(count, len(self.left)))])
        if self.suspects and not self.left and not self.running:
            self.alone = self.suspects.pop()
            self.start([self.alone])

    def start(self, cases):
        """Gives the scheduler a task."""
        texts = [(case, self.sweep.scene_text(case)) for case in cases]
        future = self.client.submit(batch_rows, texts, self.wanted, VERSION, LONGEST, pure=False)
        self.running[future.key] = (future, cases)
        future.add_done_callback(self.ended.put)

    def next_ended(self):
        """A task that has ended, with its cases; none if it takes longer."""
        try:
            key = self.ended.get(timeout=LOOK).key
        except queue.Empty:
            if self.client.status != "running":
                raise Lost(f"the client is {self.client.status}") from None
            return None
        return self.running.pop(key)

    def take(self, future, cases):
        """Keeps the rows of a task; how many they are."""
        from concurrent.futures import CancelledError

        from distributed.scheduler import KilledWorker

        try:
            rows, seconds = future.result()
        except CancelledError as why:
            raise Lost(str(why)) from why
        except KilledWorker:
            to = self.guilty if self.alone in cases else self.suspects
            to.extend(reversed(cases))
            return 0
        if rows is None:
            raise RuntimeError(f"a worker has {seconds}, and this is roulement {VERSION}: all need the same version")
        try:
            for case, row in rows:
                self.sweep.put(case, row)
        except OSError as why:
            # Of this machine's disc, and not of the scheduler, which would be waited for.
            raise RuntimeError(str(why)) from why
        self.left.extend(reversed(cases[len(rows) :]))
        self.sizes.learn(len(rows), seconds)
        return len(rows)


def run(client, sweep, missing, wanted, batch, told):
    """Runs cases on the workers that a client has at any time, and keeps their rows; `told` hears how many are done.

    Raises RuntimeError if a worker has another version, or none, if rows cannot be kept, or, after all others, if a case ends its workers;
    `Lost` and OSError if the scheduler has gone.
    """
    work, done = Work(client, sweep, missing, wanted, batch), 0
    try:
        while work.left or work.running or work.suspects:
            work.look()
            work.submit()
            ended = work.next_ended()
            if ended is not None:
                done += work.take(*ended)
            told(done, work.threads)
        if work.guilty:
            cases = ", ".join(str(case + 1) for case in sorted(work.guilty))
            raise RuntimeError(f"all others are done, but each worker that had it alone was ended by case {cases} (out of memory?)")
    finally:
        # Of a sweep that ends early: nobody waits for them.
        if work.running and client.status == "running":
            client.cancel([future for future, _ in work.running.values()])

"""Checkpoints: a run that is interrupted or killed goes on and ends with the very bits of the unbroken one."""

import os
import random
import re
import resource
import shutil
import signal
import subprocess
import time

from harness import BAD_INPUT, INTERRUPTED, NUMERICAL, SMALL_TESTER, USAGE, PelletlabTest

# A second or two of work, with frames often enough to lie on both sides of every checkpoint.
FILL = ["--set", "pellet.count=60", "--set", "time.settle_limit=0.1 s", "--set", "time.rest_kinetic_energy=1e-300",
        "--set", "output.frame_interval=0.0013 s", "--set", "output.pictures=false", "--set", "output.paraview=false"]
DRUM = [*FILL, "--set", "time.settle_limit=0.1 s", "--set", "time.spin_up=0.15 s", "--set", "time.measure=0.3 s"]
KILLED = [*FILL, "--set", "pellet.count=200", "--set", "time.settle_limit=0.6 s"]
OFTEN = ["--checkpoint-every", "0.03 s"]
CHECKPOINT = "unfinished.part/resume/run.checkpoint"


class RunsThatGoOn(PelletlabTest):
    def state_hash(self, result):
        return re.search(r"state hash ([0-9a-f]{16})", result.out).group(1)

    def bytes_of(self, *parts):
        with open(self.path(*parts), "rb") as stream:
            return stream.read()

    def has_checkpoint(self):
        return os.path.exists(self.path("out", CHECKPOINT))

    def stopped(self, verb, file, settings, number=signal.SIGINT):
        """A run into «out», stopped as soon as it has a checkpoint."""
        result = self.interrupt(self.start(verb, file, *settings, *OFTEN, "-o", "out"), self.has_checkpoint, number)
        self.assertTrue(self.has_checkpoint(), result)
        return result

    def stopped_after(self, verb, file, settings, moment):
        """The same, `moment` seconds after its begin; sooner when the machine has become so much faster that the run was over by then."""
        for _ in range(6):
            shutil.rmtree(self.path("out"), ignore_errors=True)
            process = self.start(verb, file, *settings, *OFTEN, "-o", "out")
            begin = time.monotonic()
            result = self.interrupt(process, lambda: process.poll() is not None or (self.has_checkpoint() and time.monotonic() - begin > moment))
            if result.code == INTERRUPTED:
                return
            self.assertEqual(result.code, 0, result)
            moment *= 0.5
        self.fail("the run was always over before it could be interrupted")

    def same_as_unbroken(self, verb, file, settings, resumed):
        """The resumed run in «out» has every result of an unbroken one: state, observables, and each bit of each frame."""
        unbroken = self.succeeds(verb, file, *settings, "-o", "whole")
        self.assertEqual(self.state_hash(resumed), self.state_hash(unbroken))
        for name in ("observables.json", "case.resolved.toml", "stage.json", "run.h5"):
            self.assertTrue(self.bytes_of("out", name) == self.bytes_of("whole", name), name + " differs")
        self.assertEqual(sorted(os.listdir(self.path("out"))), sorted(os.listdir(self.path("whole"))), "the checkpoint should be gone")

    def test_ctrl_c_writes_a_checkpoint_and_resume_ends_with_the_same_bits(self):
        file = self.new_case()
        for options in (OFTEN, ["--checkpoint-every", "0 s"]):  # with and without checkpoints before
            shutil.rmtree(self.path("out"), ignore_errors=True)
            process = self.start("fill", file, *FILL, *options, "-o", "out")
            result = self.interrupt(process, lambda: any("/resume/frames" in name for name in self.everything()))
            self.assertEqual(result.code, INTERRUPTED, result)
            self.assertIn("--resume", result.err, result)
            self.assertTrue(self.has_checkpoint(), result)
            self.assertEqual(sorted(os.listdir(self.path("out"))), ["unfinished.part"], "nothing but the checkpoint may be left")
        self.same_as_unbroken("fill", file, FILL, self.succeeds("fill", file, *FILL, "-o", "out", "--resume"))

    def test_a_drum_goes_on_from_any_of_its_stages(self):
        file = self.new_case("drum")
        begin = time.monotonic()
        self.succeeds("drum", file, *DRUM, *OFTEN, "-o", "whole")
        whole = time.monotonic() - begin
        for share in (0.1, 0.35, 0.7):  # of the time that the whole run takes: settling, spinning up, measuring
            self.stopped_after("drum", file, DRUM, share * whole)
            resumed = self.succeeds("drum", file, *DRUM, "-o", "out", "--resume", "--threads", "2")
            self.same_as_unbroken("drum", file, DRUM + ["--force"], resumed)

    def test_pile_and_tester_go_on_with_the_same_bits(self):
        pile = ["--set", "pellet.count=40", "--set", "time.step=2e-5 s", "--set", "funnel.top_diameter=30 mm", "--set", "funnel.outlet_diameter=16 mm",
                "--set", "funnel.outlet_height=30 mm", "--set", "time.settle_limit=0.1 s", "--set", "pile.discharge_limit=0.6 s",
                "--set", "output.pictures=false", "--set", "output.paraview=false"]
        for verb, settings in (("pile", pile), ("tester", SMALL_TESTER)):
            for folder in ("out", "whole"):
                shutil.rmtree(self.path(folder), ignore_errors=True)
            file = self.new_case(verb)
            begin = time.monotonic()
            self.succeeds(verb, file, *settings, *OFTEN, "-o", "whole")
            self.stopped_after(verb, file, settings, 0.6 * (time.monotonic() - begin))
            self.same_as_unbroken(verb, file, settings + ["--force"], self.succeeds(verb, file, *settings, "-o", "out", "--resume", "--threads", "2"))

    def test_twenty_kills_cost_nothing_but_time(self):
        file = self.new_case()
        chance = random.Random(20)
        begin = time.monotonic()
        self.stopped("fill", file, KILLED, signal.SIGKILL)
        first = time.monotonic() - begin  # so long it takes to a checkpoint: the measure of time on a machine that may be busy
        kills, steps = 1, []
        while kills < 20:
            process = self.start("fill", file, *KILLED, *OFTEN, "-o", "out", "--resume")
            time.sleep(chance.uniform(0.05, 2.5) * first)
            process.kill()
            out, _ = process.communicate()
            if process.returncode == 0:
                self.fail(f"the run was done after {kills} kills: it is too short for this test")
            self.assertEqual(process.returncode, -signal.SIGKILL)
            kills += 1
            found = re.search(r"checkpoint after (\d+) steps", out)
            if found:  # else it was killed before it could say so
                steps.append(int(found.group(1)))
        self.assertEqual(steps, sorted(steps), "a later run began further back")
        self.assertGreater(len(set(steps)), 1, "the runs did not get on")
        self.same_as_unbroken("fill", file, KILLED, self.succeeds("fill", file, *KILLED, "-o", "out", "--resume"))

    def test_a_checkpoint_is_not_lost_by_accident(self):
        file = self.new_case()
        self.stopped("fill", file, FILL)
        before = self.bytes_of("out", CHECKPOINT)
        self.fails(BAD_INPUT, "fill", file, *FILL, "-o", "out", says=["--resume", "--force"])
        self.assertEqual(self.bytes_of("out", CHECKPOINT), before)
        self.fails(BAD_INPUT, "fill", file, *FILL, "--set", "seed=5", "-o", "out", "--resume", says="another case")
        self.assertEqual(self.bytes_of("out", CHECKPOINT), before)
        self.assertNotIn("Going on", self.succeeds("fill", file, *FILL, "-o", "out", "--force").out)
        self.assertFalse(self.has_checkpoint())

    def test_damaged_checkpoints_are_refused(self):
        file = self.new_case()
        self.stopped("fill", file, FILL, signal.SIGKILL)
        whole = self.bytes_of("out", CHECKPOINT)
        for damaged in (b"", whole[:5], whole[:100], whole[: len(whole) // 2], whole[:-1], whole + b"x",
                        whole[: len(whole) // 2] + bytes([whole[len(whole) // 2] ^ 16]) + whole[len(whole) // 2 + 1:]):
            with open(self.path("out", CHECKPOINT), "wb") as stream:
                stream.write(damaged)
            self.fails(BAD_INPUT, "fill", file, *FILL, "-o", "out", "--resume", says="checkpoint")
        with open(self.path("out", CHECKPOINT), "wb") as stream:
            stream.write(whole)
        os.remove(self.path("out/unfinished.part/resume/frames.0000.h5"))
        self.fails(BAD_INPUT, "fill", file, *FILL, "-o", "out", "--resume", says="frames")

    def test_a_run_that_fails_leaves_its_last_good_checkpoint(self):
        """Gravity upwards: pellets leave the tube, which ends the run. What was kept before stays, and resuming meets the same end."""
        file = self.new_case()
        up = [*FILL, "--set", "gravity=0 m/s^2, 0 m/s^2, 9.81 m/s^2", "--set", "time.settle_limit=5 s"]
        failed = self.run_program("fill", file, *up, *OFTEN, "-o", "out")
        self.assertEqual(failed.code, NUMERICAL, failed)
        self.assertTrue(self.has_checkpoint(), failed)
        again = self.run_program("fill", file, *up, *OFTEN, "-o", "out", "--resume")
        self.assertEqual(again.code, NUMERICAL, again)
        said = [re.search(r"error: (.*)", result.err).group(1) for result in (failed, again)]
        self.assertEqual(said[0], said[1])
        self.assertTrue(self.has_checkpoint(), again)

    def test_a_file_system_that_is_full(self):
        """A real one, of 300 kB, where the tests may mount it: one error, and the checkpoint that fitted stays whole."""
        os.mkdir(self.path("out"))
        if subprocess.run(["mount", "-t", "tmpfs", "-o", "size=300k", "tmpfs", self.path("out")], capture_output=True).returncode != 0:
            self.skipTest("no right to mount a small file system")
        try:
            file = self.new_case()
            setting = [*FILL, "--set", "output.frame_interval=0.0005 s"]  # some fifty frames fit, and many checkpoints are written before the last of them
            result = self.run_program("fill", file, *setting, "--checkpoint-every", "0.003 s", "-o", "out")
            self.assertEqual(result.code, BAD_INPUT, result)
            self.assertEqual(result.err.count("error:"), 1, result)
            self.assertRegex(result.err.lower(), "no space|full", result)
            self.assertTrue(self.has_checkpoint(), result)
            shutil.copytree(self.path("out"), self.path("saved"))
        finally:
            subprocess.run(["umount", self.path("out")], check=True)
        shutil.rmtree(self.path("out"))
        os.rename(self.path("saved"), self.path("out"))
        self.same_as_unbroken("fill", file, setting, self.succeeds("fill", file, *setting, "-o", "out", "--resume"))

    def test_nothing_to_go_on_from_is_the_beginning(self):
        file = self.new_case()
        resumed = self.succeeds("fill", file, *FILL, "-o", "out", "--resume")
        self.assertIn("no checkpoint", resumed.out)
        self.assertIn("up to date", self.succeeds("fill", file, *FILL, "-o", "out", "--resume").out)

    def test_times_between_checkpoints_need_a_unit(self):
        file = self.new_case()
        self.fails(BAD_INPUT, "fill", file, *FILL, "-o", "out", "--checkpoint-every", "30", says="unit")
        self.fails(USAGE, "fill", file, *FILL, "-o", "out", "--checkpoint-every", "-3 s", says="negative")

    def test_a_disk_that_fills_up_leaves_the_last_good_checkpoint(self):
        """A limit on the size of files stands for the full disk: a few checkpoints fit, then the frames between two do not."""
        file = self.new_case()
        self.stopped("fill", file, FILL)
        before = self.bytes_of("out", CHECKPOINT)
        self.assertGreater(len(before), 8000)

        def limit():
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            resource.setrlimit(resource.RLIMIT_FSIZE, (8000, 8000))

        result = self.run_program("fill", file, *FILL, *OFTEN, "-o", "out", "--resume", preexec_fn=limit)
        self.assertEqual(result.code, BAD_INPUT, result)
        self.assertEqual(result.err.count("error:"), 1, result)
        self.assertEqual(self.bytes_of("out", CHECKPOINT), before)
        self.same_as_unbroken("fill", file, FILL, self.succeeds("fill", file, *FILL, "-o", "out", "--resume"))

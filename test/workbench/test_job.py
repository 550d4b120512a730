"""A job without a browser: its end is always reported, also the message of a verb that fails."""

from pathlib import Path

from pneumo_ros.workbench.job import Job, Line


def test_a_verb_that_fails_ends_the_job_with_its_sentence(tmp_path: Path) -> None:
    told: list[str] = []
    lines = [Line(("compare", "missing_run")), Line(("effects",))]
    job = Job("Comparing", lines, tmp_path, lambda: told.append("done"), lambda: told.append("ended"))
    job.wait(60.0)
    status = job.status()
    assert told == ["ended"]
    assert status.state == "failed"
    assert "missing_run" in status.message
    assert not (tmp_path / "effects.log").exists()


def test_verbs_run_one_after_another(tmp_path: Path) -> None:
    told: list[str] = []
    lines = [Line(("effects", "--json", "a.json")), Line(("effects", "payload_mass"))]
    job = Job("Listing", lines, tmp_path, lambda: told.append("done"), lambda: told.append("ended"))
    job.wait(120.0)
    assert told == ["done", "ended"]
    assert (job.status().state, job.status().share) == ("done", 1.0)
    assert "payload_mass" in (tmp_path / "effects.log").read_text()


def test_cancel_is_reported_at_once(tmp_path: Path) -> None:
    told: list[str] = []
    job = Job("Tuning", [Line(("tune",))], tmp_path, lambda: told.append("done"), lambda: told.append("ended"))
    job.cancel()
    assert job.status().state == "cancelled"
    job.wait(60.0)
    assert told == ["ended"]

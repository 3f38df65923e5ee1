"""The run of a report in a notebook: a frame that needs no network, with a picture and words beside it."""

import html

from gz_course.grader.report.html.replay import Replay


def test_a_run_is_replayed_in_a_frame_with_words_and_a_picture(make_report):
    bundle = Replay(make_report())._repr_mimebundle_()
    assert bundle["text/plain"].startswith("Seen from above: the robot goes from")
    assert bundle["image/svg+xml"].startswith("<svg ")
    assert bundle["text/html"].count(bundle["text/plain"]) >= 2
    page = html.unescape(bundle["text/html"].partition('srcdoc="')[2].partition('"')[0])
    assert "script-src 'sha256-" in page and page.count("<script") == 2
    assert "http://" not in page and "https://" not in page


def test_what_never_ran_is_told_in_words(not_run):
    bundle = Replay(not_run)._repr_mimebundle_()
    assert bundle["text/plain"] == "The world seen from above." and "image/svg+xml" not in bundle

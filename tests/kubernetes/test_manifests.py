"""The manifests of `kubernetes/` agree with Kubernetes, with one another, with the images and with the commands."""

import re
from pathlib import Path

import pytest
import yaml
from jsonschema import Draft202012Validator

from gz_course.grader.course import Commands
from gz_course.tests.kubernetes.schemas import SCHEMAS

ROOT = Path(__file__).parents[2]
FOLDER = ROOT / "kubernetes"
IMAGE = "gz-ros2-course-dask"


def resources():
    return {each["kind"]: each for path in FOLDER.glob("*.yaml") for each in yaml.safe_load_all(path.read_text())}


def pods():
    cluster, job = resources()["DaskCluster"]["spec"], resources()["Job"]["spec"]
    return {
        "scheduler": cluster["scheduler"]["spec"],
        "worker": cluster["worker"]["spec"],
        "grade-class": job["template"]["spec"],
        "fill-class": resources()["Pod"]["spec"],
    }


def test_every_manifest_is_one():
    assert resources().keys() == SCHEMAS.keys()
    for kind, each in resources().items():
        Draft202012Validator(SCHEMAS[kind]).validate(each)


@pytest.mark.parametrize("change", [{"replica": 1}, {"replicas": "8"}, {"spec": {}}])
def test_what_kubernetes_refuses_is_refused(change):
    cluster = resources()["DaskCluster"]
    cluster["spec"]["worker"] |= change
    assert not Draft202012Validator(SCHEMAS["DaskCluster"]).is_valid(cluster)


def test_every_pod_has_the_image_that_the_dockerfile_makes():
    ours = (FOLDER / "Dockerfile").read_text()
    assert f"-t {IMAGE} -f kubernetes/Dockerfile ." in ours
    base = re.search(r"^FROM (\S+)$", ours, re.M)[1]
    assert f"-t {base} ." in ours
    if (ROOT / "Dockerfile").is_file():
        theirs = (ROOT / "Dockerfile").read_text()
        assert f"-t {base} ." in theirs and "/opt/course" in theirs, "the environment that gets Dask"
    for pod in pods().values():
        for container in pod["containers"]:
            assert container["image"] == f"{IMAGE}:latest"
    assert re.search(r"^distributed==", (ROOT / "constraints.txt").read_text(), re.M), "the version is pinned"


def test_the_parts_find_one_another():
    cluster = resources()["DaskCluster"]
    service = cluster["spec"]["scheduler"]["service"]
    assert service["selector"]["dask.org/cluster-name"] == cluster["metadata"]["name"]
    ports = {port["name"]: port["containerPort"] for port in pods()["scheduler"]["containers"][0]["ports"]}
    assert {port["targetPort"]: port["port"] for port in service["ports"]} == ports
    arguments = pods()["grade-class"]["containers"][0]["args"]
    address = f"tcp://{cluster['metadata']['name']}-scheduler:{ports['tcp-comm']}"  # the name that the operator gives
    assert arguments[arguments.index("--dask") + 1] == address
    (volume,) = pods()["grade-class"]["volumes"]
    assert volume["persistentVolumeClaim"]["claimName"] == resources()["PersistentVolumeClaim"]["metadata"]["name"]


def test_the_job_grades_all_trials():
    arguments = pods()["grade-class"]["containers"][0]["args"]
    assert arguments[arguments.index("--trials") + 1] == "all"


def test_the_page_fills_the_volume_with_what_the_job_reads():
    """By a pod that sees the volume where the job does; hidden trials are in the solutions."""
    page = (ROOT / "docs/where_to_grade.md").read_text()
    copied = dict(re.findall(r"kubectl cp (\S+) fill-class:(/class/\S+)", page))
    job, filler = (pods()[name]["containers"][0] for name in ("grade-class", "fill-class"))
    assert job["volumeMounts"] == filler["volumeMounts"]
    assert pods()["fill-class"]["volumes"] == pods()["grade-class"]["volumes"]
    (root,) = [each["value"] for each in job["env"] if each["name"] == "COURSE_ROOT"]
    assert copied == {
        "class.zip": job["args"][3], "exercises": f"{root}/exercises", "solutions": f"{root}/solutions",
    }  # fmt: skip
    out = job["args"][job["args"].index("--out") + 1]
    assert f"kubectl cp fill-class:{out} " in page
    order = [page.index(each) for each in ("apply -f kubernetes/fill", "delete pod fill", "apply -f kubernetes/grade")]
    assert order == sorted(order), "one machine at a time has the volume"
    applied = set(re.findall(r"kubectl apply -f kubernetes/(\S+)", page))
    assert applied == {path.name for path in FOLDER.glob("*.yaml")}


@pytest.mark.proof
def test_the_commands_have_these_options():
    scheduler = pytest.importorskip("distributed.cli.dask_scheduler")
    worker = pytest.importorskip("distributed.cli.dask_worker")
    grade_all = Commands(name="course").get_command(None, "grade-all")
    known = {"scheduler": scheduler.main, "worker": worker.main, "grade-class": grade_all}
    for name, pod in pods().items():
        if name not in known:
            continue
        program, verb, *arguments = pod["containers"][0]["args"]
        assert (program, verb) in {("dask", "scheduler"), ("dask", "worker"), ("course", "grade-all")}
        options = {option for each in known[name].params for option in (*each.opts, *each.secondary_opts)}
        assert {each for each in arguments if each.startswith("--")} <= options


def test_one_grading_in_each_pod():
    arguments = pods()["worker"]["containers"][0]["args"]
    assert arguments[arguments.index("--nthreads") + 1] == "1"

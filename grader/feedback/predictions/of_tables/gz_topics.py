"""Topics of Gazebo that were put below the wrong name."""

from __future__ import annotations

from gz_course.grader.feedback.predictions.tables import Column, explains_column


@explains_column("gz_topic")
def names_below_the_model(column: Column) -> str:
    """Recognise topics that do not exist in Gazebo because they were put below the model or the world."""
    wrong = [(row, link) for row, link in column.pairs if f"/{row['gz_topic'].lstrip('/')}" != link.gz_topic]
    for start, words in (("/model/", "the model's"), ("/world/", "the world's")):
        if wrong and all(
            row["gz_topic"].startswith(start)
            and not link.gz_topic.startswith(start)
            and row["gz_topic"] not in column.gz_topics
            for row, link in wrong
        ):
            return (
                f"line {wrong[0][0]['line']}: {wrong[0][0]['gz_topic']} has {words} name in it; not every topic has: "
                "one that a sensor's <topic> names is called just that"
            )
    return ""


@explains_column("gz_topic")
def another_model(column: Column) -> str:
    """Recognise topics below a model that this world does not have."""
    wrong = [(row, link) for row, link in column.pairs if f"/{row['gz_topic'].lstrip('/')}" != link.gz_topic]
    parts = [(f"/{row['gz_topic'].lstrip('/')}".split("/"), link.gz_topic.split("/")) for row, link in wrong]
    names = {said[2] for said, _ in parts if len(said) > 3}
    if len(names) != 1 or any(topic.startswith(f"/model/{name}/") for name in names for topic in column.gz_topics):
        return ""
    if any(said[:2] != ["", "model"] or right[:2] != said[:2] or said[3:] != right[3:] for said, right in parts):
        return ""
    row = wrong[0][0]
    return (
        f"line {row['line']}: {row['gz_topic']} begins with the name of a model, {names.pop()}, and no model of this "
        "world has that name: gz topic -l shows the topics with the name of its robot"
    )

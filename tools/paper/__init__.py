"""The paper's experiments: what they measure, how they are judged, and how the paper is printed.

`python3 -m tools.paper help`, from the root of the repository, lists the commands; README.md says how
to write an experiment.
"""

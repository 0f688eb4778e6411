"""Random scenes over the whole feature space, the truth of every number that leaves MFV, and the verdict of each.

`python -m truth` runs scenes (scripts/deep-truth.sh); `test_truth.py` runs a few hundred of them in the suite.
"""

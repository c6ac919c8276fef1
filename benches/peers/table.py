"""The lines of both sides as a markdown table."""

import json
import math
import sys


def read(path):
    with open(path) as lines:
        results = [json.loads(line) for line in lines if line.startswith("{")]
    return {result["name"]: result for result in results}


ours, theirs = read(sys.argv[1]), {}
for path in sys.argv[2:]:
    theirs |= read(path)
print("| work | Auxetica, a step | the peer, a step | ratio | end states differ by |")
print("|---|---|---|---|---|")
for name, our in ours.items():
    their = theirs.get(name)
    if their is None:
        print(f"| {name} | {our['us']:.4g} us | not measured | | |")
        continue
    apart = math.dist(our["moved"], their["moved"]) / math.hypot(*their["moved"])
    ratio = their["us"] / our["us"]
    print(f"| {name} | {our['us']:.4g} us | {their['us']:.4g} us | {ratio:.1f} | {apart:.1e} of the way moved |")

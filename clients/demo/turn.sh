#!/bin/sh
# A rod that turns by a quarter of a radian from step to step, and a post that it sweeps between two
# of them: a scene for each step, of the pose that the rod has then. The rod reaches 1.002 from its
# middle, which does not move: so the margin is 0.25 * 1.002.
awk 'BEGIN {
    for (step = 0; step < 12; step++) {
        half = step * 0.25 / 2
        printf "{\"dim\": 2, \"duration\": 0, \"margin\": 0.2505, \"label\": \"step %d\", \"bodies\": [", step
        printf "{\"id\": 1, \"name\": \"rod\", \"shape\": \"box\", \"size\": [2,0.125], \"orientation\": [%.17g,%.17g]}, ",
            cos(half), sin(half)
        print "{\"id\": 2, \"name\": \"post\", \"shape\": \"box\", \"size\": [0.03125,0.03125], \"position\": [0.1875,0.921875]}]}"
    }
}'

#!/bin/bash
# A perception laboratory's day: from a folder of pictures to thresholds of people and tables.
#
#   laboratory.sh PICTURES ANSWERS OUT [BLOCK]
#
# PICTURES   a folder of pictures of one viewpoint, by any renderer, with their samples per pixel (spp) in
#            the names: kitchen_20.png, kitchen_40.png, ...
# ANSWERS    a folder where the files are that observers save; or a thresholds file that is there already,
#            whose row has the name of the folder PICTURES
# OUT        a folder for the results; BLOCK: pixels a side of the blocks [200]
#
# Without answers yet, it makes the study for observers, and ends there. Each step is one command, whose
# --help says more; LULL names another program.
set -euo pipefail
if [ $# -lt 3 ]; then
    sed -n '2,15s/^# \{0,1\}//p' "$0" >&2
    exit 2
fi
pictures=$1 answers=$2 out=$3 block=${4:-200}
lull=${LULL:-lull}
mkdir -p "$out"

# 1. SVD-entropies of all blocks against spp, as a table for any plotting program.
$lull entropy --images "$pictures" --block "$block" --csv "$out/entropies.csv" >"$out/entropies.txt"

# 2. A page on which observers say where they still see noise, and their thresholds.
human=$answers
if [ -d "$answers" ]; then
    [ -e "$out/study.html" ] ||
        $lull study --images "$pictures" --block "$block" --levels "${LEVELS:-28}" -o "$out/study.html"
    if ! compgen -G "$answers/*.json" >/dev/null; then
        echo "Give $out/study.html to observers, and put the files that they save in $answers."
        exit
    fi
    human=$out/human.csv
    $lull study --collect "$answers"/*.json --study "$out/study.html" -o "$human" \
        --report "$out/collected.html"
fi

# 3. The pictures as a data set, and a model of these observers' sight.
$lull record --images "$pictures" --block "$block" -o "$out/data.h5"
$lull train "$out/data.h5" --human "$human" -o "$out/own.h5" --quiet >"$out/training.txt"

# 4. The tables: how far rules stop from people, and how their numbers fall in each block.
$lull evaluate "$out/data.h5" --human "$human" --stop learned --stop "learned:$out/own.h5" \
    --csv "$out/table.csv" --blocks "$out/blocks.csv" --curves "$out/curves.csv" |
    tee "$out/table.txt"

# 5. The images that the rule and the observers leave, compared with the last picture.
$lull compare --images "$pictures" --human "$human" --block "$block" -o "$out/" \
    --report "$out/compare.html"

#!/bin/sh
# Graphs held against themselves: how often chance gives a verdict. One row a graph: runs, and those whose errors were called different.
#
#     tools/evidence/compare_aa.sh PROGRAM OUT.json COMMIT DATE
set -eu
program=$1 out=$2 commit=$3 date=$4
folder=out/evidence/compare_aa
rows=
adapter=
for graph in light_sampling restir_di_unbiased; do
    verdicts=0
    for seed in 1 2 3 4 5 6 7 8 9 10; do
        run=$folder/$graph-$seed
        [ -e "$run/report.json" ] || "$program" compare "$graph" "$graph" --scene cornell --size 32x18 --warm-up 8 --seeds 16 --seed "$seed" \
            --reference-samples 4096 --cache "$folder/cache" -o "$run" >/dev/null
        grep -q '"better": "not_resolved"' "$run/report.json" || verdicts=$((verdicts + 1))
        adapter=$(sed -n 's/^ *"adapter": "\(.*\)",$/\1/p' "$run/report.json" | head -n 1)
    done
    rows="$rows${rows:+,}
    {\"graph\": \"$graph\", \"runs\": 10, \"verdicts\": $verdicts}"
done
mkdir -p "$(dirname "$out")"
cat >"$out" <<END
{
  "commit": "$commit",
  "date": "$date",
  "adapter": "$adapter",
  "rows": [$rows
  ]
}
END

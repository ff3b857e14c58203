#!/bin/bash
# compare.sh A B [SCENE…]: what two commits take for scenes, by turns in one run, stage by stage.
#
# Each commit is built in a work tree of its own, with the `frames` bench of this one, so that commits before it compare
# too. They run by turns, the first of each pair by turns as well; a ratio is of one pair, B ÷ A, and below 1 means that B
# is faster. Printed are the medians and an interval that holds the true median in 19 of 20 (order statistics).
# Environment: ROUNDS (12 pairs), REPEAT (5 runs each, of which the least counts), THREADS (1), GELRAY_DATA.
set -euo pipefail

if [ $# -lt 2 ]; then
    echo "compare.sh: two commits are expected, and then scenes: compare.sh A B [SCENE…]" >&2
    exit 2
fi
first=$1 second=$2
shift 2
scenes=("${@:-figure_06a}")
here=$(cd "$(dirname "$0")/.." && pwd)
work=${COMPARE_FOLDER:-$(mktemp -d)}

build() { # build COMMIT FOLDER: prints the program
    local tree="$work/$2"
    [ -d "$tree" ] || git -C "$here" worktree add --detach --quiet "$tree" "$1"
    cp "$here/benches/frames.rs" "$here/benches/timed.rs" "$tree/benches/"
    grep -q 'name = "frames"' "$tree/Cargo.toml" ||
        printf '\n[[bench]]\nname = "frames"\nharness = false\n' >>"$tree/Cargo.toml"
    cargo bench --quiet --no-run --bench frames --manifest-path "$tree/Cargo.toml" \
        --message-format json 2>/dev/null |
        sed -n 's/.*"executable":"\([^"]*frames[^"]*\)".*/\1/p' | tail -1
}

cleanup() {
    [ -n "${COMPARE_FOLDER:-}" ] && return
    for tree in a b; do git -C "$here" worktree remove --force "$work/$tree" 2>/dev/null || true; done
    rm -rf "$work"
}
trap cleanup EXIT

a=$(build "$first" a)
b=$(build "$second" b)
for scene in "${scenes[@]}"; do
    for ((round = 0; round < ${ROUNDS:-12}; round++)); do
        order="A B"
        [ $((round % 2)) = 1 ] && order="B A"
        for side in $order; do
            program=$a
            [ $side = B ] && program=$b
            "$program" "$scene" "${THREADS:-1}" "${REPEAT:-5}" | sed "s/^/$round $side /"
        done
    done | sort -s -k3,4 | awk -v scene="$scene" '
        function report(   i, j, x, n, r, low, high) {
            n = 0
            for (i in A) if (i in B) ratio[++n] = B[i] / A[i]
            if (n == 0) return
            for (i = 2; i <= n; i++) {
                x = ratio[i]
                for (j = i - 1; j > 0 && ratio[j] > x; j--) ratio[j + 1] = ratio[j]
                ratio[j + 1] = x
            }
            r = int(n / 2 - 0.98 * sqrt(n)); if (r < 1) r = 1
            printf "%-16s %-6s %-14s %9.3f ms → %9.3f ms   B/A %.3f [%.3f, %.3f]\n",
                scene, kind, stage, least["A"], least["B"], ratio[int((n + 1) / 2)], ratio[r], ratio[n + 1 - r]
        }
        $3 " " $4 != key {
            report(); key = $3 " " $4; kind = $3; stage = $4
            delete A; delete B; delete ratio; least["A"] = least["B"] = 1e9
        }
        {
            if ($2 == "A") A[$1] = $5; else B[$1] = $5
            if ($5 < least[$2]) least[$2] = $5
        }
        END { report() }'
done

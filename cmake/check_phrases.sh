#!/bin/bash
# Refuses phrases that the style of texts (CONTRIBUTING.md) rules out, in documents, and in the strings of
# programs: help, messages, labels. Prints each place; fails if there is one.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

# A phrase a line, with the term to use.
phrases='not modelled: not supported
of a core: CPU time
of processors: CPU time
core minutes: CPU time
by the clock: wall-clock time
in the mean: on average
anew: again
nobody: no observer, or a statement without a subject
goes on: continues'
pattern=$(cut -d: -f1 <<<"$phrases" | paste -sd'|')

documents=$(find . -name '*.md' -not -path './build/*' -not -name CONTRIBUTING.md)
sources=$(find renderer stopping -name '*.cpp' -o -name '*.h' -o -name '*.js' -o -name '*.html')
# A string does not cross a line; a comment behind code is none.
found=$({
    grep -niE "\b($pattern)\b" $documents
    grep -niE "[\"\`][^\"\`]*\b($pattern)\b[^\"\`]*[\"\`]" $sources | grep -vE ':[0-9]+: *//'
} || true)
[ -z "$found" ] && exit
echo "$found"
echo "Phrases to avoid, with the terms to use:"
echo "$phrases"
exit 1

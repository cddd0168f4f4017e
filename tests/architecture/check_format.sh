#!/usr/bin/env bash
# check_format.sh ROOT: all sources look as .clang-format says. Exit code 77 (skipped) without clang-format 14, whose
# choices the project follows; other versions differ.
set -euo pipefail
cd "$1"
clang-format --version 2>/dev/null | grep -q 'version 14\.' || exit 77
find core spectral optics io validation cli tests \( -name '*.h' -o -name '*.cpp' \) -print0 |
    xargs -0 clang-format --dry-run --Werror

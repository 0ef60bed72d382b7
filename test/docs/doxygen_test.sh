#!/usr/bin/env bash
# doxygen_test.sh SOURCE_DIR OUT_DIR: the input filter turns plain comments into Doxygen's, and the API pages build without
# a warning and contain them. Without diagrams, which take most of the time of ./rover docs.
set -euo pipefail
cd "$1"
fail() {
  printf 'doxygen_test: %s\n' "$*" >&2
  exit 1
}
rm -rf "$2"
mkdir -p "$2"

cat >"$2/header.hpp" <<'TEXT'
// Text of the file. Email a@b, <tag>, `a < b`.
#pragma once

namespace rover {

class Main {
 public:
  // Above \ref.
  int f() const {  // opening line
    // in a body
    return 1;  // in a body too
  }
  double limit_m = "//"[0];  // trailing
                             // continued
};

// A heading
int one;  // first
int two;  // second

}  // namespace rover
TEXT
cat >"$2/expected.hpp" <<'TEXT'
/// \file
/// Text of the file. Email a\@b, \<tag\>, `a < b`.

namespace rover {

/** Text of the file. Email a\@b, \<tag\>, `a < b`. */ class Main {
 public:
  /// Above \\ref.
  int f() const {  // opening line
    // in a body
    return 1;  // in a body too
  }
  double limit_m = "//"[0];  ///< trailing
                             ///< continued
};

// A heading
int one;  ///< first
int two;  ///< second

}  // namespace rover
TEXT
awk -f docs/doxygen_filter.awk "$2/header.hpp" | diff "$2/expected.hpp" - || fail "the filter's text differs"

{
  cat docs/Doxyfile
  printf 'OUTPUT_DIRECTORY = %s\nHAVE_DOT = NO\n' "$2"
} | doxygen - || fail "Doxygen warns"
grep -q 'supervisor</a>' "$2/html/index.html" || fail "the main page lists no folders"
[ "$(cat "$2"/html/*.html | grep -c 'class="mdescRight"')" -gt 1000 ] || fail "members have lost their comments"

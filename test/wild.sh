# Sourced by tests in bash: wild_row KIND INPUT BEFORE NOW, as in wild.hpp.
wild_row() {
  [ -z "${ROVER_WILD_ROWS:-}" ] || printf '%s\t%s\t%s\t%s\n' "${@//[$'\n\t|']/ }" >>"$ROVER_WILD_ROWS"
}

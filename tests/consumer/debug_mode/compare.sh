# Compiles main.cpp by the compiler $1 without and with libstdc++'s debug mode, and compares what the two programs $2 and
# $2_debug print.
set -eu
compile() {
  "$compiler" -std=c++20 -O0 "$@" "$(dirname "$0")/main.cpp" $(pkg-config --cflags --libs broadside)
}
compiler=$1
compile -o "$2"
compile -D_GLIBCXX_DEBUG -o "$2_debug"
"$2" > "$2.txt"
"$2_debug" > "$2_debug.txt"
diff "$2.txt" "$2_debug.txt"
grep -q "the same again: 1" "$2.txt"

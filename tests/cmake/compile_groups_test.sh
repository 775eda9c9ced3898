#!/usr/bin/env bash
# cmake/compile-groups puts neighbours together, and files that would meet in one compilation into different groups.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
sandbox=$(mktemp -d)
trap 'rm -rf "$sandbox"' EXIT
cd "$sandbox"
mkdir a b cmake
cp "$root/cmake/compile-groups" cmake

fail() { echo "FAILED: $1" >&2; exit 1; }

# unit FILE LINES [LATER]: a source whose unnamed namespace has these lines, and other lines after it.
unit() {
  printf 'namespace telltale {\nnamespace {\n\n%b\n}  // namespace\n\n%b\n}  // namespace telltale\n' "$2" "${3-}" > "$1"
}

# expect GROUPS OPTION...: the groups of all sources, in order; those of the target by their numbers.
expect() {
  local expected=$1 found
  shift
  found=$(cmake/compile-groups "$@" a/*.cpp b/*.cpp | sed 's/^target_//; s/ .*//' | xargs)
  [[ $found == "$expected" ]] || fail "compile-groups $*: $found instead of $expected"
}

unit a/one.cpp 'int First() {\n  return 1;\n}\n\ndouble Mean(double x) {\n  const double local = x;\n  return local;\n}\n'
unit a/two.cpp 'constexpr std::array<double, 2> kSteps = {1.0, 2.0};\n'
unit b/three.cpp 'struct Row {\n  double local = 0.0;\n};\n'
expect '1 1 1' target 9
expect 'a_1 a_1 b_1' folder 9
expect '1 1 2' target 2

# Names that both files have, for functions, constants, types, aliases and macros.
for shared in 'int Mean(int n);\n' 'std::vector<std::pair<int, int>> Mean(const Rows& rows);\n' \
  'constexpr int Mean = 1;\n' 'const int Mean[] = {1};\n' 'struct Mean {};\n' 'enum class Mean { kA };\n' \
  'using Mean = double;\n' 'using statistics::Mean;\n' 'template <class T>\nT Mean(T t);\n' '#define Mean 1\n'; do
  unit a/two.cpp "$shared"
  expect '1 others_1 1' target 9
done

# Functions of one name that take objects of different classes first are overloads, also of one in a header. They are
# none where one takes a number, or what a template leaves open, or another thing of that name.
unit a/one.cpp 'void Write(const Spread& spread, proto::Spread& message) {\n}\n'
unit a/two.cpp 'void Write(const proto::Onset& onset) {\n}\n'
expect '1 1 1' target 9
unit a/two.cpp '' '#include "telltale/b/mean.hpp"\n'
echo '#include "telltale/b/inner.hpp"' > b/mean.hpp
unit b/inner.hpp '' 'void Write(const Onset& onset);\nstd::string Spread::Write(double indent) const;\n'
expect '1 1 1' target 9
for shared in 'void Write(const Spread& spread);\n' 'void Write(double number);\n' 'void Write(const Eigen::VectorXd& x);\n' \
  'template <class Message>\nvoid Write(const Message& message);\n' 'struct Write {};\n'; do
  unit a/two.cpp "$shared"
  expect '1 others_1 1' target 9
done
# Nor where one is taken as a value.
unit a/one.cpp 'void Write(const Spread& spread) {\n}\n\nconst auto writes = Write;\n'
unit a/two.cpp 'void Write(const Onset& onset) {\n}\n'
expect '1 others_1 1' target 9
unit a/one.cpp 'int First() {\n  return 1;\n}\n\ndouble Mean(double x) {\n  const double local = x;\n  return local;\n}\n'

# A constant of one file, and a local one or an enumerator of another.
unit a/one.cpp 'constexpr int kRows = 1;\n'
unit a/two.cpp '' 'int Count() {\n  constexpr int kRows = 2;\n  return kRows;\n}\n'
expect '1 others_1 1' target 9
unit a/two.cpp 'enum Change : int { kRows = 0, kPort = 1 };\n'
expect '1 others_1 1' target 9
unit a/two.cpp ''
sed -i '1i #include "telltale/b/change.hpp"' a/two.cpp
unit b/change.hpp '' 'enum class Change { kRows, kPort };\n'
expect '1 others_1 1' target 9
unit a/one.cpp 'int First();\ndouble Mean(double x);\n'

# A type of one file, and a local one.
unit a/one.cpp 'using Clock = std::chrono::steady_clock;\n'
unit a/two.cpp '' 'void Wait() {\n  using Clock = std::chrono::system_clock;\n}\n'
expect '1 others_1 1' target 9
unit a/one.cpp 'int First();\ndouble Mean(double x);\n'

# A name that one file has and another declares for others, or finds in a header.
unit a/two.cpp '' 'double Mean(double x) { return x; }\n'
expect '1 others_1 1' target 9
unit a/two.cpp ''
sed -i '1i #include "telltale/b/mean.hpp"' a/two.cpp
echo '#include "telltale/b/inner.hpp"' > b/mean.hpp
unit b/inner.hpp '' 'double Mean(double x);\n'
expect '1 others_1 1' target 9

# A namespace of a library's name, which hides the library's from files that do not know it.
unit a/one.cpp 'const auto kPart = testing::HasSubstr("part");\n'
printf 'namespace telltale::testing {\nint Boats();\n}\n' > b/inner.hpp
expect '1 others_1 1' target 9

# Neither comments, strings, members nor names within a function count.
unit b/inner.hpp ''
unit a/one.cpp 'double Mean(double x);\n'
unit a/two.cpp '// Mean\nconstexpr const char* kTitle = "Mean";\nstruct Row2 {\n  double Mean() const;\n};\n'
expect '1 1 1' target 9

echo "files that would meet come into different groups"

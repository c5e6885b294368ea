"""Sources that are compiled as one (LACUNA_BATCHED_FOLDERS) share no name that each means for itself alone, and open no
namespace for those behind them: so the batches mean what the sources mean one by one."""

import collections
import pathlib
import re
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
NOISE = re.compile(r'//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|(?<![0-9a-fA-F])\'(?:\\.|[^\'\\\n])+\'', re.DOTALL)
TYPE = re.compile(r"\b(?:struct|class|enum(?:\s+class)?|union)\s+(?:alignas\([^)]*\)\s*)?(\w+)")
MACRO = re.compile(r"[A-Z][A-Z0-9_]+")  # TEST(...) {...}: what it defines has the names of its arguments


def batched_folders(cmake):
    text = re.sub(r"#[^\n]*", "", cmake.read_text())
    return re.search(r"set\(LACUNA_BATCHED_FOLDERS([^)]*)\)", text)[1].split()


def plain(text):
    """Without comments, texts and preprocessor lines."""
    text = NOISE.sub(lambda m: '""' if m[0][0] in "R\"'" else " ", text)
    return re.sub(r"^[ \t]*#(?:[^\n]*\\\n)*[^\n]*", "", text, flags=re.MULTILINE)


def statements(text):
    """The declarations of one level: what stands before the body or the `;`, and the body, if there is one. Braces
    within parentheses, as of arguments, are no body."""
    depth, start, head, body = 0, 0, "", 0
    for i, c in enumerate(text):
        if c in "{(":
            if depth == 0 and c == "{":
                head, body = text[start:i], i + 1
            depth += 1
        elif c in "})":
            depth -= 1
            if depth == 0 and c == "}":
                yield head, text[body:i]
                start = i + 1
        elif c == ";" and depth == 0:
            yield text[start:i], None
            start = i + 1


def without(text, left, right):
    """Without what stands between these brackets."""
    out, depth = [], 0
    for c in text:
        depth += c == left
        if depth == 0:
            out.append(c)
        depth -= c == right and depth > 0
    return "".join(out)


def declared(head):
    """The name that a declaration at namespace level gives, or none."""
    head = re.sub(r"\[\[.*?\]\]", "", head).strip()
    head = re.sub(r"^template\s*", "", without(re.sub(r"->|operator\s*\S+?(?=\()", "operator", head), "<", ">")).strip()
    head = re.sub(r"^requires\b[^;]*?(?=\b(?:auto|void|bool|std|int|struct|class)\b)", "", head)
    if not head or re.match(r"(?:using\s+namespace|namespace|friend|static_assert|extern)\b", head) or "operator" in head:
        return None
    if match := re.match(r"(?:using|concept)\s+(\w+)\s*=", head):
        return match[1]
    if (match := TYPE.match(head)) and "(" not in head:
        return match[1]
    before = re.split(r"[(=]", head)[0]
    match = re.search(r"(?<![:\w~])(\w+)\s*(?:\[[^\]]*\]\s*)*$", before)
    if match is None or MACRO.fullmatch(before.strip()):
        return None
    return match[1]


def own_names(text, unnamed=False):
    """What the source defines for itself alone: in its unnamed namespaces, and static."""
    for head, body in statements(text):
        if body is not None and (match := re.fullmatch(r"\s*(?:inline\s+)?namespace\b\s*([\w:]*)\s*", head)):
            yield from own_names(body, unnamed or not match[1])
        elif re.fullmatch(r'\s*extern\s+""\s*', head):
            yield from own_names(body, unnamed)
        elif unnamed or re.match(r"\s*static\b", head):
            if name := declared(head):
                yield name


def violations(root, folders):
    for folder in folders:
        owners = collections.defaultdict(list)
        for source in sorted((root / folder).glob("*.cpp")):
            text = plain(source.read_text())
            for name in sorted(set(own_names(text))):
                owners[name].append(source.name)
            for opened in re.findall(r"^using\s+namespace\s+([\w:]+)", text, re.MULTILINE):
                if not re.fullmatch(r"std::(\w+_)?literals", opened):
                    yield f"{folder}/{source.name} opens {opened} for the sources behind it"
        for name, sources in owners.items():
            if len(sources) > 1:
                yield f"{folder}: {name} is in {', '.join(sources)}"


class Batches(unittest.TestCase):
    def test_no_name_is_in_two_sources(self):
        self.assertEqual(sorted(violations(ROOT, batched_folders(ROOT / "CMakeLists.txt"))), [])

    def test_the_folders_are_there(self):
        for folder in batched_folders(ROOT / "CMakeLists.txt"):
            self.assertTrue(list((ROOT / folder).glob("*.cpp")), folder)

    def test_every_kind_of_name_is_found(self):
        text = """
namespace lacuna {
namespace {
// int in_comment;
constexpr std::array<int, 2> table{{1, 2}};
const char* const texts[] = {"struct InText {", "}"};
enum class Kind { a, b };
struct Row : Base<int> { int member = 0; void method() { int local; } };
using Json = nlohmann::json;
template <class T, std::size_t N = 3>
[[nodiscard]] std::optional<std::vector<T>> read(const T& x, int n = f(2)) { return {}; }
std::uint64_t forward(int);
class Row::Nested {};
auto lambda = [](int y) { return y; };
bool operator<(const Row& a, const Row& b);
template <class T>
concept Small = sizeof(T) < 8;
TEST(Suite, Name) { int inner; }
INSTANTIATE_TEST_SUITE_P(All, Suite, Range(Size{0}, argument().size()), [](int i) { return name(i); });
namespace alias = std::filesystem;  // twice the same, or it does not compile
namespace inside { int deep() { return 1; } }
}  // namespace
static int file_static(double x) { return 0; }
int open_to_all() { return 0; }
}  // namespace lacuna
"""
        self.assertEqual(sorted(set(own_names(plain(text)))),
                         ["Json", "Kind", "Row", "Small", "deep", "file_static", "forward", "lambda", "read", "table",
                          "texts"])

    def test_a_planted_collision_is_found(self):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            for name, text in {"a/x.cpp": "namespace {\nint shown(int v) { return v; }\nint one;\n}\n",
                               "a/y.cpp": "namespace n { namespace {\nstd::string shown(double);\n} }\nusing namespace n;\n",
                               "a/z.cpp": "static bool one(int) { return true; }\nint shown;\n",
                               "b/x.cpp": "namespace {\nint shown;\n}\n"}.items():
                (root / name).parent.mkdir(exist_ok=True)
                (root / name).write_text(text)
            self.assertEqual(sorted(violations(root, ["a", "b"])), [
                "a/y.cpp opens n for the sources behind it",
                "a: one is in x.cpp, z.cpp",
                "a: shown is in x.cpp, y.cpp"])


if __name__ == "__main__":
    result = unittest.main(exit=False).result
    bad = len(result.failures) + len(result.errors)
    print(f"{result.testsRun - bad} passed, {bad} failed")
    sys.exit(bad > 0)

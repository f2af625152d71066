#!/usr/bin/env python3
"""Checks that each source includes the standard headers of the names that it uses.

A header counts if the file names it, or a header of lull's own that the file includes, directly or by others of ours: all else that a
standard library includes differs between versions. Prints the missing ones.
"""
import functools
import pathlib
import re

ROOT = pathlib.Path(__file__).resolve().parents[1]
FOLDERS = ("renderer", "stopping", "tests", "scenes")
# Names in std by header, with which a line begins; headers on a line without a colon have one name, their own. Several headers
# declare some names, and any of these will do.
NAMES = r"""
chrono complex condition_variable deque filesystem initializer_list list numbers string_view vector
array: array to_array
atomic: atomic(?:_\w+)? memory_order\w*
bit: bit_cast bit_width bit_floor bit_ceil popcount countl_zero countr_zero has_single_bit rotl endian
charconv: from_chars to_chars chars_format
cmath: sqrt abs fabs sin cos tan asin acos atan2? exp2? expm1 log2? log10 log1p pow floor ceil round lround trunc fmod hypot isnan
    isfinite isinf cbrt copysign signbit fma erf erfc sinh cosh tanh atanh nextafter ldexp frexp lgamma tgamma remainder fmin fmax
    ilogb modf nearbyint rint llround
cstdio: printf fprintf snprintf fopen fclose fread fwrite fflush fseek fputs puts FILE rename remove\( perror getc fgetc
cstring: memcpy memcmp memset memmove memchr strlen strcmp strncmp strerror strchr strrchr strstr
ctime: time_t tm strftime localtime gmtime time
exception: exception exception_ptr current_exception rethrow_exception terminate uncaught_exceptions
fstream: ifstream ofstream fstream filebuf
functional: function hash less greater plus multiplies reference_wrapper cref bind identity ranges::less ranges::greater equal_to
    not_fn invoke
future: future promise async packaged_task shared_future
iomanip: setprecision setw setfill quoted put_time get_time
iostream: cout cerr cin clog
iterator: back_inserter istreambuf_iterator istream_iterator ostream_iterator ostreambuf_iterator move_iterator make_move_iterator
    inserter reverse_iterator forward_iterator input_iterator
limits: numeric_limits
map: map multimap
memory: unique_ptr make_unique shared_ptr make_shared weak_ptr addressof enable_shared_from_this construct_at destroy_at
mutex: mutex recursive_mutex lock_guard unique_lock scoped_lock once_flag call_once
numeric: accumulate iota partial_sum inner_product reduce gcd lcm midpoint exclusive_scan inclusive_scan transform_reduce
    adjacent_difference
optional: optional nullopt nullopt_t make_optional
queue: queue priority_queue
random: mt19937(?:_64)? uniform_real_distribution uniform_int_distribution normal_distribution random_device
    exponential_distribution poisson_distribution minstd_rand0? bernoulli_distribution lognormal_distribution geometric_distribution
    discrete_distribution
regex: regex smatch cmatch regex_match regex_search regex_replace sregex_iterator
set: set multiset
span: span as_bytes as_writable_bytes dynamic_extent
sstream: istringstream ostringstream stringstream stringbuf
stdexcept: runtime_error logic_error invalid_argument out_of_range domain_error length_error overflow_error range_error
string: string to_string stoi stod stof stoul stoull stol stoll getline u16string u32string u8string wstring
system_error: error_code system_error errc generic_category system_category make_error_code
thread: thread jthread this_thread
tuple: tuple make_tuple tie apply tuple_size\w* tuple_element\w* forward_as_tuple ignore
type_traits: is_same\w* is_base_of\w* enable_if\w* decay\w* remove_cv\w* remove_reference\w* remove_cvref\w* conditional\w*
    is_floating_point\w* is_integral\w* is_arithmetic\w* is_trivially_\w+ is_const\w* is_invocable\w* invoke_result\w*
    underlying_type\w* is_enum\w* make_unsigned\w* make_signed\w* is_convertible\w* is_constructible\w* is_void\w*
    is_constant_evaluated true_type false_type integral_constant bool_constant void_t type_identity\w* is_aggregate\w* is_signed\w*
    is_unsigned\w* is_default_constructible\w* is_nothrow_\w+
unordered_map: unordered_map unordered_multimap
unordered_set: unordered_set unordered_multiset
utility: move forward pair make_pair exchange swap declval index_sequence\w* make_index_sequence integer_sequence in_place\w*
    cmp_\w+ to_underlying as_const unreachable
variant: variant visit get_if holds_alternative monostate variant_size\w* variant_alternative\w*
"""
OTHERS = {
    "algorithm": r"std::(?:ranges::)?(?:sort|stable_sort|nth_element|partial_sort|max_element|min_element|minmax_element|minmax|clamp|"
                 r"copy_n|copy_if|copy|fill_n|fill|find_if_not|find_if|find|any_of|all_of|none_of|count_if|count|transform|"
                 r"lower_bound|upper_bound|equal_range|binary_search|reverse|rotate|replace|remove_if|unique|partition|"
                 r"stable_partition|is_sorted|max|min|equal|for_each|generate|set_difference|includes|shuffle|mismatch|search|"
                 r"adjacent_find|lexicographical_compare|starts_with|ends_with)\b(?=\s*[(<])",
    "cassert": r"\bassert\s*\(",
    "cerrno": r"\b(?:errno|E(?:NOENT|ACCES|INTR|EXIST|INVAL|NOSPC|PIPE|AGAIN|ISDIR|NOTDIR|RANGE))\b",
    "csignal": r"std::(?:signal|raise|sig_atomic_t)\b|\bSIG(?:INT|TERM|KILL|SEGV|HUP|STOP)\b",
    "cstddef": r"std::(?:byte|ptrdiff_t|nullptr_t|max_align_t)\b|\boffsetof\b",
    "cstdint": r"\b(?:u?int(?:8|16|32|64)_t|u?intptr_t|U?INT(?:8|16|32|64)_(?:MAX|MIN))\b",
    "cstdlib": r"std::(?:getenv|strtod|strtof|strtol|strtoul|strtoull|strtoll|exit|abort|atoi|atof|malloc|free|system|_Exit|quick_exit)\b"
               r"|\bEXIT_(?:SUCCESS|FAILURE)\b",
    "fmt/ranges.h": r"\bfmt::join\b",  # its declaration moved there
    "typeinfo": r"\btypeid\b",
}
# Headers that the standard says declare the names of another too, as far as those are used here.
ALSO = {
    "string_view": {"string"}, "initializer_list": {"vector", "string", "map", "set", "array", "span", "algorithm", "unordered_map",
                                                    "utility", "optional", "variant", "memory", "deque"},
    "exception": {"stdexcept", "system_error"}, "iterator": {"vector", "string", "array", "map", "span"},
    "utility": {"map", "unordered_map", "tuple", "vector", "algorithm", "memory", "optional", "variant", "functional"},
    "cstddef": {"span"}, "mutex": {"condition_variable"}, "tuple": {"map"},
    "cmath": {"complex"}, "system_error": {"filesystem", "charconv", "cerrno"},
    "string": {"sstream", "filesystem", "fstream", "regex", "stdexcept", "system_error"},
    "type_traits": {"variant", "utility", "memory", "functional"},
}
C_NAMES = {"cmath": "math.h", "cstdint": "stdint.h", "cstddef": "stddef.h", "cstring": "string.h", "cstdio": "stdio.h",
           "cstdlib": "stdlib.h", "csignal": "signal.h", "ctime": "time.h", "cassert": "assert.h", "cerrno": "errno.h"}
COMPILED = {header: re.compile(names) for header, names in OTHERS.items()}
for line in re.sub(r"\n ", "", NAMES).split("\n"):
    headers, _, names = line.partition(":")
    for header in headers.split():
        COMPILED[header] = re.compile(rf"std::(?:{'|'.join(names.split() or [header])})\b")
NOT_CODE = re.compile(r'//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"', re.S)
INCLUDE = re.compile(r'^\s*#\s*include\s*(<[^>]+>|"[^"]+")', re.M)


@functools.cache
def text(path):
    return path.read_text(encoding="utf-8")


@functools.cache
def included(path):
    """Returns the headers that a file names: of the system, and of ours as paths."""
    system, ours = set(), set()
    for name in INCLUDE.findall(text(path)):
        plain = name[1:-1]
        candidates = (ROOT / plain, path.parent / plain, ROOT / "renderer/embedding/include" / plain)
        found = next((c for c in candidates if c.is_file()), None)
        if found:
            ours.add(found.resolve())
        else:
            system.add(plain)
    return system, ours


def all_included(path):
    system, seen, todo = set(), set(), [path]
    while todo:
        file = todo.pop()
        if file not in seen:
            seen.add(file)
            named, ours = included(file)
            system |= named
            todo += ours
    return system


def missing(path):
    """Yields (line, name, header) for each header that a file lacks."""
    code = NOT_CODE.sub(lambda m: '""' + "\n" * m[0].count("\n"), text(path))
    there = all_included(path)
    for header, names in COMPILED.items():
        use = names.search(code)
        if use and not there & {header, C_NAMES.get(header, header), *ALSO.get(header, ())}:
            yield code.count("\n", 0, use.start()) + 1, use[0], header


def files():
    for folder in FOLDERS:
        yield from sorted(p for p in (ROOT / folder).rglob("*") if p.suffix in (".h", ".cpp"))


def main():
    errors = [f"{path.relative_to(ROOT)}:{line}: {name} needs <{header}>" for path in files() for line, name, header in missing(path)]
    print("\n".join(errors) or "Each file includes what it uses")
    raise SystemExit(1 if errors else 0)


if __name__ == "__main__":
    main()

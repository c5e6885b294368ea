# The parts of `./dev test`, how each is run and counted, and in what order: read by ./dev.

# What failed, by name, as GoogleTest, Node, unittest, tests/fuzz and tests/extremes write it; where none of
# them came to write it, what was running.
failed_names() {  # failed_names LOG
  sed -nE '/ # (SKIP|TODO)/d
    s/^\[  FAILED  \] (.*) \([0-9]+ ms\)$/\1/p
    s/^ *not ok [0-9]+ - (.*)/\1/p
    s/^(FAIL|ERROR): (.*)/\2/p
    s/^([a-z_]+) +FAILED .*/\1/p
    s/^RED +(.*)/\1/p' "$1" | grep . || awk '
    /^\[ RUN      \]/ {open[$4] = 1}
    /^\[       OK \]|^\[  FAILED  \]/ {delete open[$4]}
    END {for (name in open) print "broke off in " name}' "$1"
}

count() {  # count NAME PASSED FAILED SINCE: SINCE as of $SECONDS; what failed stands in the log of that name
  printf '%-28s %5d passed, %d failed %8d s\n' "$1" "$2" "$3" "$((SECONDS - $4))"
  echo "$2 $3" >>build/test-logs/counts
  [ "$3" -eq 0 ] && return
  local log=build/test-logs/$1.log names= name
  [ ! -f "$log" ] || names=$(failed_names "$log")
  while IFS= read -r name; do printf 'failed: %s%s\n' "$1" "${name:+: ${name:0:160}}"; done <<<"$names" \
    >>build/test-logs/failed
}

# A GoogleTest program without its long tests, or PROGRAM:FILTER: its own counts; one that crashes is one failure
# more.
run_gtest() {
  local name=${1%%:*} filter='-Long*' log ok bad since=$SECONDS status=0
  [[ $1 != *:* ]] || filter=${1#*:}
  log=build/test-logs/$name.log
  "build/release/tests/$name" --gtest_brief=0 --gtest_filter="$filter" >"$log" 2>&1 || status=$?
  ok=$(grep -c '^\[       OK \]' "$log" || true)
  bad=$(grep -cE '^\[  FAILED  \] .* \([0-9]+ ms\)$' "$log" || true)
  [ "$status" -ne 0 ] && [ "$bad" -eq 0 ] && bad=1
  [ "$ok" -eq 0 ] && [ "$bad" -eq 0 ] && bad=1
  count "$name" "$ok" "$bad" "$since"
  [ "$bad" -eq 0 ] || { grep -vE '^\[ +(OK|RUN) +\]' "$log" || true; } | tail -n 60
}

# A folder of Node tests.
run_node() {
  local name=$1 folder=$2 log ok bad status=0 since=$SECONDS
  log=build/test-logs/$name.log
  (cd "$folder" && node --test --test-reporter=tap *.test.mjs) >"$log" 2>&1 || status=$?
  ok=$(awk '/^# pass /{n=$3} END{print n+0}' "$log")
  bad=$(awk '/^# (fail|cancelled) /{n+=$3} END{print n+0}' "$log")
  [ "$status" -ne 0 ] && [ "$bad" -eq 0 ] && bad=1
  [ "$ok" -eq 0 ] && [ "$bad" -eq 0 ] && bad=1
  count "$name" "$ok" "$bad" "$since"
  [ "$bad" -eq 0 ] || awk '/^# Subtest/{show=0} /^ *not ok /{show=1} show || /^# (tests|pass|fail)/' "$log" | head -n 200
}

# What the tests and the bench of the page drive Chromium with.
browser_driver() {
  if [ tests/web/package-lock.json -nt tests/web/node_modules/.package-lock.json ]; then
    (cd tests/web && npm ci --no-audit --no-fund --silent) || die "npm could not install the browser driver"
  fi
}

# Any command: one test.
run_check() {
  local name=$1 log=build/test-logs/$1.log since=$SECONDS
  shift
  if "$@" >"$log" 2>&1; then count "$name" 1 0 "$since"; else count "$name" 0 1 "$since"; tail -n 60 "$log"; fi
}

# A command that closes with "N passed, N failed" itself.
run_counted() {  # run_counted NAME COMMAND...
  local name=$1 log=build/test-logs/$1.log ok bad since=$SECONDS status=0
  shift
  "$@" >"$log" 2>&1 || status=$?
  read -r ok bad < <(awk '/^[0-9]+ passed, [0-9]+ failed$/{print $1, $3; found=1} END{if (!found) print 0, 1}' "$log" |
    tail -n 1)
  [ "$status" -ne 0 ] && [ "$bad" -eq 0 ] && bad=1
  count "$name" "$ok" "$bad" "$since"
  [ "$bad" -eq 0 ] || tail -n 200 "$log"
}

# The parts of the suite, and of these the programs of unit.
groups='unit extremes scenes architecture cli reproduce install server python kills web fuzz'
test_programs() { sed -nE 's/^lacuna_tests\(([a-z_]+) .*/\1/p' tests/CMakeLists.txt; }

has_word() { [[ " $(tr '\n' ' ' <<<"$1") " == *" $2 "* ]]; }  # has_word WORDS WORD

known_part() {  # known_part NAME: there is such a part, or what there is
  has_word "$groups $(test_programs)" "$1" && return
  [[ $1 == *:?* ]] && has_word "$(test_programs)" "${1%%:*}" && return
  die "there is no test \"$1\"; there are the groups $groups, the programs of unit
$(test_programs | paste -sd ' ' | fold -s -w 100 | sed 's/^/  /')
and a GoogleTest filter after one of these, as test_core:Rng*"
}

targets_of() {  # targets_of PART: of the release preset
  case "$1" in
    unit) test_programs ;;
    test_*) echo "${1%%:*}" ;;
    extremes) echo extremes ;;
    architecture | cli | reproduce) echo lacuna ;;
    fuzz) echo fuzz ;;
    server | python | kills | web | install) echo lacuna lacuna-server ;;
  esac
}

run_part() {
  local program
  case "$1" in
    unit) for program in $(test_programs); do run_gtest "$program"; done ;;
    test_*) run_gtest "$1" ;;
    extremes) run_counted extremes build/release/bin/extremes --quick ;;
    scenes) run_check scenes python3 jobs/scenes/make_scenes.py --check ;;
    architecture)
      run_counted architecture python3 tests/architecture/test_includes.py
      run_counted batches python3 tests/architecture/test_batches.py
      run_counted docs python3 tests/architecture/test_docs.py
      run_counted faults python3 tests/architecture/test_faults.py
      run_check format check_format
      ;;
    cli) run_node cli tests/jobs/cli ;;
    reproduce) run_counted reproduce python3 tests/jobs/reproduce ;;
    install)
      run_counted packages python3 tests/install/test_setup.py
      run_counted install python3 tests/install/test_package.py
      ;;
    server) run_node server tests/server ;;
    python) run_counted python python3 tests/python/test_client.py ;;
    kills) run_node kills tests/soak ;;
    web) run_node web tests/web ;;
    fuzz) run_counted fuzz python3 tests/fuzz/fuzz.py --replay ;;
  esac
}

build_parts() {  # build_parts [PART...]: what they run; without PART the programs: run_all builds the rest of what it runs
  local part targets=()
  setup "$needs_build"
  [ $# -gt 0 ] || build release lacuna lacuna-server
  for part; do targets+=($(targets_of "$part")); done
  [ ${#targets[@]} -eq 0 ] || build release "${targets[@]}"
  if [ $# -eq 0 ] || has_word "$*" install; then setup "$needs_package"; fi
  if [ $# -eq 0 ] || has_word "$*" architecture; then setup "$needs_format"; fi
  if [ $# -gt 0 ] && ! [[ " $* " =~ \ (cli|server|kills|web)\  ]]; then return; fi
  setup "$needs_test"
  if [ $# -eq 0 ] || has_word "$*" web; then browser_driver; fi
}

lane() { local part; for part; do run_part "$part"; done; }

ended() { wait -n || count "a part of the tests broke off" 0 1 "$SECONDS"; }

# Two parts at a time, of lower priority, in this order: the longest first.
behind() {
  local part
  for part; do
    while [ "$(jobs -rp | wc -l)" -ge 2 ]; do ended; done
    run_part "$part" &
  done
  while [ -n "$(jobs -rp)" ]; do ended; done
}

# Two processors. `server`, `web`, `kills` and `python` wait for processes more than they compute: they go first, as soon as the
# programs are built, and all else takes what they leave: the rest of the build, then the other parts.
run_all() {
  local part long='test_renderer cli extremes'
  trap 'kill 0' INT  # which a subshell by itself does not hear
  lane server web kills python &
  (renice -n 10 -p "$BASHPID" >/dev/null
    if (build release $(for part in $groups; do targets_of "$part"; done)); then
      behind $long $(test_programs | grep -vx test_renderer) reproduce install scenes architecture fuzz
    else
      count build 0 1 "$SECONDS"
    fi) &
  ended
  ended
}

tests() {  # tests [PART...]
  local part passed failed
  for part; do known_part "$part"; done
  build_parts "$@"
  rm -rf build/test-logs
  mkdir -p build/test-logs
  LACUNA_SCENES=$(scenes_roots)
  export LACUNA_SCENES
  if [ $# -eq 0 ]; then run_all; else for part; do run_part "$part"; done; fi
  read -r passed failed < <(awk '{p += $1; f += $2} END {print p + 0, f + 0}' build/test-logs/counts)
  [ ! -f build/test-logs/failed ] || cat build/test-logs/failed
  echo "$passed passed, $failed failed"
  [ "$failed" -eq 0 ]
}

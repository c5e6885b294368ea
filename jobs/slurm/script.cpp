#include "jobs/slurm/script.h"

#include <fmt/format.h>

#include <string_view>

namespace lacuna {
namespace {

/// "export NAME='value'" for each.
std::string exports(const std::vector<std::string>& environment) {
  std::string text;
  for (const std::string& entry : environment) {
    const auto equals = entry.find('=');
    text += fmt::format("export {}={}\n", entry.substr(0, equals),
                        shell_word(entry.substr(equals + 1)));
  }
  return text;
}

std::string threads_word(bool all_cores) {
  return all_cores ? R"( --threads "${SLURM_CPUS_PER_TASK:-${SLURM_CPUS_ON_NODE:-0}}")" : "";
}

/// Needs $name and $folder.
constexpr std::string_view wait_for_folder = R"(
# A shared folder may lag behind. The renderer starts only while the folder waits for this very
# submission: one that was given up, or that nobody noticed, does nothing.
tries=0
until grep -qsF "\"$name\"" "$folder/slurm.json"; do
  tries=$((tries + 1))
  if [ "$tries" -gt 60 ]; then
    echo "$(hostname): $folder does not name $name, or is not visible on this node" >&2
    exit 0
  fi
  sleep 1
done
)";

/// Sets $code.
std::string render_and_hand_on(const std::filesystem::path& directory, const std::string& command) {
  return fmt::format(R"(child=
asked=
trap 'asked=1; [ -z "$child" ] || kill -TERM "$child" 2>/dev/null' TERM
cd {} || exit 1
{} &
child=$!
[ -z "$asked" ] || kill -TERM "$child" 2>/dev/null
wait "$child"
code=$?
while kill -0 "$child" 2>/dev/null; do
  wait "$child"
  code=$?
done
)",
                     shell_word(directory), command);
}

}  // namespace

std::string shell_word(const std::string& text) {
  std::string word = "'";
  for (const char c : text) {
    if (c == '\'') {
      word += "'\\''";
    } else {
      word += c;
    }
  }
  return word + "'";
}

std::string script_text(const SlurmScript& script) {
  return fmt::format(
      R"(#!/bin/sh
# The batch script of one submission to Slurm, which a queue of Lacuna has written.
name={name}
folder={folder}
{exports}{wait}# A renderer of a node that was given up may still be at work.
if command -v flock >/dev/null; then
  flock --wait 86400 "$folder/.lock" true || exit 1
fi
rm -f "$folder/slurm.exit"
{render}printf '%s %s\n' "$name" "$code" >"$folder/.slurm.exit.$$.tmp" &&
  mv "$folder/.slurm.exit.$$.tmp" "$folder/slurm.exit"
exit "$code"
)",
      fmt::arg("name", shell_word(script.name)), fmt::arg("folder", shell_word(script.folder)),
      fmt::arg("exports", exports(script.environment)), fmt::arg("wait", wait_for_folder),
      fmt::arg("render", render_and_hand_on(script.directory, shell_word(script.renderer) +
                                                                  " render \"$folder\"" +
                                                                  threads_word(script.all_cores))));
}

}  // namespace lacuna

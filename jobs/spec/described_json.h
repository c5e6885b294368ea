#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "jobs/spec/json_document.h"
#include "jobs/spec/json_reader.h"
#include "jobs/spec/json_writer.h"

namespace lacuna {

/// Throws BadJob if there are problems, with the first hundred and the number of the rest.
inline void throw_if_any(std::vector<Problem> problems) {
  constexpr std::size_t most = 100;
  if (problems.empty()) return;
  if (problems.size() > most) {
    const std::size_t more = problems.size() - most;
    problems.resize(most);
    problems.push_back({"", std::to_string(more) + " more problems"});
  }
  throw BadJob(std::move(problems));
}

/// Reads a document that is one described struct. Throws BadJob.
template <Described T>
T read_document(std::string_view text, DocumentLimits limits) {
  std::vector<Problem> problems;
  const Json document = parse_document(text, limits, problems);
  T settings{};
  read_settings(document, problems, settings);
  throw_if_any(std::move(problems));
  return settings;
}

template <Described T>
std::string write_document(const T& settings) {
  return document_text(ObjectWriter::value_of(settings));
}

// Instantiated in job_json.cpp only: it needs code for every setting, which takes long to compile.
struct JobSpec;
extern template OrderedJson ObjectWriter::value_of(const JobSpec& job);

}  // namespace lacuna

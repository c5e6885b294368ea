#include "jobs/run/trace.h"

#include <fmt/format.h>

#include "base/storage/atomic_file.h"

namespace lacuna {

void write_trace(const WorkLog& log, const std::filesystem::path& file) {
  std::string text = "{\"displayTimeUnit\":\"ms\",\"lostSpans\":";
  text += fmt::format("{},\"traceEvents\":[", log.lost_spans());
  const char* separator = "\n";
  for (std::size_t thread = 0; thread < log.spans().size(); ++thread) {
    for (const WorkLog::Span& span : log.spans()[thread]) {
      text += fmt::format(
          "{}{{\"name\":\"{}\",\"ph\":\"X\",\"pid\":1,\"tid\":{},\"ts\":{:.3f},\"dur\":{:.3f},"
          "\"args\":{{\"cpu\":{:.3f},\"loop\":{},\"body\":{}}}}}",
          separator, log.names()[span.section], thread, 1e6 * span.begin,
          1e6 * (span.end - span.begin), 1e6 * span.cpu, span.loop, span.body);
      separator = ",\n";
    }
  }
  text += "\n]}\n";
  write_file_atomically(file, text, false);
}

}  // namespace lacuna

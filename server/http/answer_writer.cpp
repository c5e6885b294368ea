#include "server/http/answer_writer.h"

#include <httplib.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <thread>
#include <utility>
#include <vector>

#include "base/log/log.h"

namespace lacuna {
namespace {

using namespace std::chrono_literals;

// Closing a connection with unread input resets it, which discards a response that the client has
// not read yet; so wait this long first.
constexpr auto linger_time = 1s;
constexpr std::size_t piece_bytes = 64 * 1024;

}  // namespace

// The library closes a connection after a failed content provider: to close it, the provider fails
// at its end.
void AnswerWriter::put(Response response, bool closes, const httplib::Request& sent,
                       httplib::Response& out) const {
  // The library passes its request as a constant reference, but writes the response by it. It would
  // apply ranges to any response, which files have done already. For HEAD it calls no provider, so
  // a HEAD that must close is answered as a GET.
  auto& request = const_cast<httplib::Request&>(sent);
  request.ranges.clear();
  if (closes && request.method == "HEAD") request.method = "GET";
  if (response.stream && request.version == "HTTP/1.0") closes = true;  // without chunked encoding
  out.status = response.status;
  for (const auto& [name, value] : response.headers) out.set_header(name, value);
  if (closes) out.set_header("Connection", "close");
  const std::string type = response.content_type;
  const std::size_t size =
      response.file ? static_cast<std::size_t>(response.file->length) : response.body.size();
  if (response.stream) {
    put_stream(std::move(response), closes, out);
  } else if (size > 0) {
    put_content(size, std::move(response), closes, out);
  } else if (closes) {
    out.set_content_provider(type, [this](std::size_t, httplib::DataSink& client) {
      linger(client);
      return false;
    });
  } else {
    out.set_header("Content-Type", type);
  }
  if (type.empty()) out.headers.erase("Content-Type");
}

AnswerWriter::Source AnswerWriter::source_of(Response response) {
  if (!response.file) {
    return [text = std::move(response.body)](std::size_t offset, std::size_t length) {
      return std::string_view(text).substr(offset, length);
    };
  }
  return [begin = response.file->offset,
          file = std::make_shared<FileHandle>(std::move(response.file->file)),
          buffer = std::vector<char>(piece_bytes)](std::size_t offset, std::size_t length) mutable {
    const ssize_t n = ::pread(file->get(), buffer.data(), std::min(length, buffer.size()),
                              begin + static_cast<off_t>(offset));
    return std::string_view(buffer.data(), static_cast<std::size_t>(std::max<ssize_t>(0, n)));
  };
}

// Texts are sent by a provider, too: the library would compress the body of a response, but an ETag
// identifies bytes.
void AnswerWriter::put_content(std::size_t size, Response response, bool closes,
                               httplib::Response& out) const {
  const std::string type = response.content_type;
  auto provider = [this, closes, source = source_of(std::move(response))](
                      std::size_t offset, std::size_t length, httplib::DataSink& client) {
    const std::string_view piece = source(offset, length);
    if (piece.empty() || !client.write(piece.data(), piece.size())) return false;
    metrics_.bytes_out += piece.size();
    if (!closes || piece.size() < length) return true;
    linger(client);
    return false;
  };
  out.set_content_provider(size, type, std::move(provider));
}

void AnswerWriter::put_stream(Response response, bool closes, httplib::Response& out) const {
  auto provider = [this, closes, next = std::move(response.stream),
                   open = std::make_shared<Counted>(metrics_.streams)](std::size_t,
                                                                       httplib::DataSink& client) {
    if (stopping_ || !client.is_writable()) return false;
    try {
      const auto text = next();
      if (text && text->empty()) return true;
      if (text) {
        metrics_.bytes_out += text->size();
        return client.write(text->data(), text->size());
      }
      client.done();
      return !closes;
    } catch (const std::exception& error) {  // the head is sent already
      log::error("a response ends early: {}", error.what());
      return false;
    }
  };
  if (closes) {
    out.set_content_provider(response.content_type, std::move(provider));
  } else {
    out.set_chunked_content_provider(response.content_type, std::move(provider));
  }
}

void AnswerWriter::linger(const httplib::DataSink& client) const {
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + linger_time;
  while (!stopping_ && client.is_writable() && Clock::now() < end) {
    std::this_thread::sleep_for(10ms);
  }
}

}  // namespace lacuna

#include "telltale/client/cli/leave_note.hpp"

#include <unistd.h>

#include <atomic>
#include <csignal>
#include <forward_list>

namespace telltale {
namespace {

constexpr int kSignalled = 128;

// What a handler of signals may read: a text that never changes once it is here.
std::atomic<const std::string*> leave_note = nullptr;
static_assert(std::atomic<const std::string*>::is_always_lock_free);

void Leave(int signal) {
  const std::string* note = leave_note;
  if (note != nullptr) {
    [[maybe_unused]] const auto written = write(STDERR_FILENO, note->data(), note->size());
  }
  _exit(kSignalled + signal);
}

void Handle(void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  for (const int signal : {SIGINT, SIGTERM}) sigaction(signal, &action, nullptr);
}

}  // namespace

LeaveNote::LeaveNote(const std::string& note) {
  Change(note);
  Handle(Leave);
}

LeaveNote::~LeaveNote() {
  Handle(SIG_DFL);
}

void LeaveNote::Change(const std::string& note) {
  // Kept to the end, since a handler may be reading it: a program changes it once or twice.
  static std::forward_list<std::string> notes;
  leave_note = &notes.emplace_front('\n' + note + '\n');
}

}  // namespace telltale

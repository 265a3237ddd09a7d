// Consoles and interruptions on Windows.
#include "lab/platform/terminal.hpp"

#include <cstdio>

#include <fcntl.h>
#include <io.h>
#include <shellapi.h>
#include <windows.h>

namespace broadside::lab::platform {
namespace {

void (*interruption_handler)() = nullptr;

HANDLE handle_of(int descriptor) { return reinterpret_cast<HANDLE>(_get_osfhandle(descriptor)); }

std::string in_utf8(const wchar_t* wide) {
  const int bytes = WideCharToMultiByte(CP_UTF8, 0, wide, -1, nullptr, 0, nullptr, nullptr);
  if (bytes <= 1) return {};
  std::string text(static_cast<std::size_t>(bytes), '\0');
  WideCharToMultiByte(CP_UTF8, 0, wide, -1, text.data(), bytes, nullptr, nullptr);
  text.pop_back();  // the terminating null
  return text;
}

}  // namespace

bool is_terminal(int descriptor) {
  // Not _isatty(), which is also true for NUL.
  DWORD mode = 0;
  return GetConsoleMode(handle_of(descriptor), &mode) != 0;
}

std::size_t terminal_width() {
  CONSOLE_SCREEN_BUFFER_INFO screen{};
  if (!GetConsoleScreenBufferInfo(handle_of(_fileno(stdout)), &screen)) return 0;
  return static_cast<std::size_t>(screen.srWindow.Right - screen.srWindow.Left + 1);
}

void prepare_standard_streams() {
  for (std::FILE* const stream : {stdin, stdout, stderr}) _setmode(_fileno(stream), _O_BINARY);
  SetConsoleOutputCP(CP_UTF8);
  for (std::FILE* const stream : {stdout, stderr}) {
    const HANDLE handle = handle_of(_fileno(stream));
    DWORD mode = 0;
    if (GetConsoleMode(handle, &mode)) SetConsoleMode(handle, mode | ENABLE_VIRTUAL_TERMINAL_PROCESSING);
  }
}

std::vector<std::string> arguments(int count, const char* const* values) {
  // main() gets its arguments in the system's code page, which lacks some letters.
  int wide_count = 0;
  wchar_t** const wide = CommandLineToArgvW(GetCommandLineW(), &wide_count);
  if (wide == nullptr) return {values, values + count};
  std::vector<std::string> texts;
  for (int i = 0; i < wide_count; ++i) texts.push_back(in_utf8(wide[i]));
  LocalFree(wide);
  return texts;
}

void on_interruption(void (*handle)()) {
  interruption_handler = handle;
  SetConsoleCtrlHandler(
      [](DWORD) -> BOOL {
        interruption_handler();
        return TRUE;
      },
      TRUE);
}

void on_failing_write(void (*)()) {}

}  // namespace broadside::lab::platform

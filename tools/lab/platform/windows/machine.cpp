// The machine's properties on Windows.
#include "lab/platform/machine.hpp"

#include <array>

#include <fmt/format.h>
#include <windows.h>

namespace broadside::lab::platform {
namespace {

/// A string value under HKEY_LOCAL_MACHINE in the registry.
std::string registered(const wchar_t* key, const wchar_t* name) {
  std::array<wchar_t, 256> wide{};
  DWORD bytes = sizeof(wide);
  if (RegGetValueW(HKEY_LOCAL_MACHINE, key, name, RRF_RT_REG_SZ, nullptr, wide.data(), &bytes) !=
      ERROR_SUCCESS)
    return {};
  std::array<char, 4 * wide.size()> text{};
  WideCharToMultiByte(CP_UTF8, 0, wide.data(), -1, text.data(), static_cast<int>(text.size()), nullptr,
                      nullptr);
  const std::string name_with_spaces = text.data();
  const std::size_t last = name_with_spaces.find_last_not_of(' ');
  return last == std::string::npos ? "" : name_with_spaces.substr(0, last + 1);
}

}  // namespace

std::string processor_name() {
  return registered(LR"(HARDWARE\DESCRIPTION\System\CentralProcessor\0)", L"ProcessorNameString");
}

std::string system_name() {
  const wchar_t* const key = LR"(SOFTWARE\Microsoft\Windows NT\CurrentVersion)";
  const std::string product = registered(key, L"ProductName");
  return fmt::format("{}, build {}", product.empty() ? "Windows" : product,
                     registered(key, L"CurrentBuildNumber"));
}

double clock_mhz() {
  DWORD mhz = 0;
  DWORD bytes = sizeof(mhz);
  const LSTATUS status =
      RegGetValueW(HKEY_LOCAL_MACHINE, LR"(HARDWARE\DESCRIPTION\System\CentralProcessor\0)", L"~MHz",
                   RRF_RT_REG_DWORD, nullptr, &mhz, &bytes);
  return status == ERROR_SUCCESS ? static_cast<double>(mhz) : 0;
}

std::vector<Cache> caches() { return {}; }

std::optional<double> load() { return std::nullopt; }

std::uint64_t memory_bytes() {
  MEMORYSTATUSEX status{};
  status.dwLength = sizeof(status);
  return GlobalMemoryStatusEx(&status) ? status.ullTotalPhys : 0;
}

}  // namespace broadside::lab::platform

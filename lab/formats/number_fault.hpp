// Why a text is no number, for errors.
#pragma once

#include <string>
#include <string_view>

namespace broadside::lab::readers {

/// What is wrong with a text that is no number, and what is expected instead.
struct NumberFault {
  std::string found;  ///< such as "with a decimal comma"; empty where there is no more to say than the text
  std::string expected;  ///< such as "a decimal point"; empty where it depends on what reads the number
};

/// Looks at a text that could not be read as a number.
NumberFault number_fault(std::string_view text);

}  // namespace broadside::lab::readers

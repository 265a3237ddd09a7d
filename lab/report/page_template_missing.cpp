// What stands in for the page where Node or the npm packages of web/ were missing at configure time.
#include "lab/report/page_template.hpp"

namespace broadside::lab {

PageTemplate page_template() { return {}; }

}  // namespace broadside::lab

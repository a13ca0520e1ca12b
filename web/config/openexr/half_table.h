/* half_table.h - a function of halves as a table, computed when the module starts: the library's own tables are 2 MB of data. */
#include <cmath>

#include "half.h"

class half_table
{
  public:
    explicit half_table(half (*compute)(half x))
    {
        for (int bits = 0; bits < 65536; bits++) {
            half x;
            x.setBits(static_cast<unsigned short>(bits));
            values_[bits] = compute(x).bits();
        }
    }
    operator const unsigned short *() const
    {
        return values_;
    }

  private:
    unsigned short values_[65536];
};

# (128, 0, 0, 129) is red 1, as for most programs, and a written file is read to the same.
{ printf '#?RADIANCE\n\n-Y 1 +X 2\n'; for i in 1 2; do printf '\200\000\000\201'; done; } >red.hdr
{ printf 'PF\n2 1\n-1\n'; for i in 1 2; do printf '\000\000\200\077\000\000\000\000\000\000\000\000'; done; } >red.pfm
expect 0 compare red.pfm red.hdr --max differing=0

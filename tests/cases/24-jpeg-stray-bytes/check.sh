# Four zero bytes before a marker of the header change nothing.
expect 0 compare "$case_dir/good.jpg" "$case_dir/junk.jpg" --max differing=0

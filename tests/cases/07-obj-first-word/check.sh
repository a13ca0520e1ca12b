# A file with vertices and faces is an OBJ file, whatever its first word is.
expect 0 render "$case_dir/newmtl.obj" -o newmtl.png --size 32
says 'line 1: the statement is unknown'
for first in 'Exported by a program of 1998' '// a comment' '%made by hand'; do
    { echo "$first"; sed 1,2d "$case_dir/newmtl.obj"; } >other.obj
    expect 0 render other.obj -o other.png --size 32
    says 'line 1: the statement is unknown'
done
printf 'hello\nf is for friends\nv is for victory\n' >words.obj
expect 4 render words.obj -o words.png --size 32
says 'is neither a .glb file'

# Pages and their statistics, by Debian's own Python, where matplotlib, h5py and scipy are.
foreach(name plots cost)
  add_test(NAME unit/${name} COMMAND /usr/bin/python3 -B -m unittest ${name}_test
           WORKING_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR}/unit)
  set_tests_properties(unit/${name} PROPERTIES LABELS unit TIMEOUT 300 ENVIRONMENT "OMP_NUM_THREADS=1")
endforeach()

# The report's functions, by Debian's own Python, where matplotlib and h5py are.
add_test(NAME unit/plots COMMAND /usr/bin/python3 -B -m unittest plots_test
         WORKING_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR}/unit)
set_tests_properties(unit/plots PROPERTIES LABELS unit TIMEOUT 300 ENVIRONMENT "OMP_NUM_THREADS=1")

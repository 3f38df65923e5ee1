gz model -m robot -p

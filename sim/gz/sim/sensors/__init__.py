"""The sensors: one file per sensor type, found by scanning this folder; the systems of `gz.sim.systems` run
them.
"""

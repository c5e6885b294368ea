"""Small faults, each of which the tests must notice."""

import faults_import
import faults_jobs
import faults_paths
import faults_scenes
import faults_server
import faults_strategies
import faults_web

FAULTS = [fault for part in (faults_paths, faults_strategies, faults_scenes, faults_import, faults_jobs, faults_server,
                                faults_web) for fault in part.FAULTS]

#include "tasks/app/app.h"

int main(int argc, char** argv) { return pincer::tasks::runApp(argc, argv); }
